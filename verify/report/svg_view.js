// A flat drawing for browsers without WebGL: outlines of the shapes, the farthest first.
import {cornersOf} from './corners.js';
import {rotate, worldHalfspace} from './data.js';
import {addNotice} from './notice.js';
import {axesOfView, hullOf} from './projection.js';

const NS = 'http://www.w3.org/2000/svg';
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

export class SvgView {
  constructor(stage, data, survey, theme) {
    this.name = 'svg';
    this.data = data;
    this.survey = survey;
    this.theme = theme;
    this.corners = new Map();
    this.element = document.createElementNS(NS, 'svg');
    this.element.setAttribute('role', 'img');
    this.element.setAttribute('preserveAspectRatio', 'xMidYMid meet');
    stage.insertBefore(this.element, stage.firstChild);
    addNotice(stage, 'This browser has no WebGL: flat drawing.');
    this.onDrawn = () => {};
    this.setView('side');
  }

  setTheme(theme) {
    this.theme = theme;
    if (this.state) this.show(this.state);
  }
  setView(name) {
    this.axes = axesOfView(name);
    if (this.state) this.show(this.state);
  }
  onUserMove() {}
  pick() { return null; }

  flat(p) { return [dot(p, this.axes.right), -dot(p, this.axes.up)]; }

  polygon(shape, p, q) {
    if (!this.corners.has(shape)) {
      this.corners.set(shape, cornersOf(shape).map((corner) => rotate(shape.q, corner).map((v, k) => v + shape.p[k])));
    }
    const world = this.corners.get(shape).map((corner) => rotate(q, corner).map((v, k) => v + p[k]));
    const depth = world.reduce((sum, point) => sum + dot(point, this.axes.back), 0) / world.length;
    return {depth, outline: hullOf(world.map((point) => this.flat(point)))};
  }

  show(state) {
    this.state = state;
    const {data, survey, theme} = this;
    const {frames} = data;
    const parts = [];
    const marked = new Set(frames.marked(state.frame));
    const touching = new Set(frames.contacts(state.frame).map((contact) => contact.body));
    data.objects.forEach((object) => object.pieces.forEach((piece) => {
      if (piece.kind === 'halfspace') this.addHalfspace(piece, object.name, parts);
      else parts.push({...this.polygon(piece, [0, 0, 0], [0, 0, 0, 1]), title: object.name, fill: theme.object,
        line: theme.objectEdge, opacity: state.xray ? 0.25 : piece.kind === 'surface' ? 0.35 : 0.9});
    }));
    data.bodies.forEach((body, index) => {
      const pose = Array.from(frames.poseOf(state.frame, index));
      for (const link of body.links) {
        for (const shape of link.shapes) {
          const fill = marked.has(index) ? theme.fails : touching.has(index) ? theme.contact : theme.robot;
          parts.push({...this.polygon(shape, pose.slice(0, 3), pose.slice(3)), title: link.name, fill,
            line: theme.robotEdge, opacity: fill === theme.contact ? 0.4 : 0.92});
        }
      }
    });
    parts.sort((a, b) => a.depth - b.depth);
    this.element.replaceChildren(...parts.map((part) => this.draw(part)), ...this.marks(state));
    const [u, v] = this.flat(survey.centre), r = 1.02 * survey.radius;
    this.element.setAttribute('viewBox', [u - r, v - r, 2 * r, 2 * r].join(' '));
    requestAnimationFrame(() => this.onDrawn());
  }

  // Seen from its edge a halfspace is everything below a line.
  addHalfspace(piece, title, parts) {
    const {normal, distance} = worldHalfspace(piece);
    if (Math.abs(dot(normal, this.axes.back)) > 0.05) return;
    const wide = 20 * this.survey.radius;
    const [nu, nv] = this.flat(normal);
    const off = dot(this.survey.centre, normal) - distance;
    const middle = this.flat(this.survey.centre.map((value, k) => value - off * normal[k]));
    const at = (along, down) => [middle[0] - along * nv - down * nu, middle[1] + along * nu - down * nv];
    parts.push({depth: -Infinity, title, fill: this.theme.floor, line: this.theme.grid, opacity: 1,
      outline: [at(-wide, 0), at(wide, 0), at(wide, wide), at(-wide, wide)]});
  }

  draw({outline, fill, line, opacity, title}) {
    const item = node('polygon', {points: outline.map((p) => p.map((v) => v.toFixed(4)).join(',')).join(' '), fill,
      stroke: line, 'stroke-width': 0.004 * this.survey.radius, 'stroke-linejoin': 'round', 'fill-opacity': opacity});
    const label = node('title', {});
    label.textContent = title;
    item.appendChild(label);
    return item;
  }

  marks(state) {
    const {theme, data: {frames}} = this;
    const width = 0.005 * this.survey.radius;
    const out = [];
    const segment = (from, to, stroke, extra) => {
      const [a, b] = [this.flat(from), this.flat(to)];
      out.push(node('line', {x1: a[0], y1: a[1], x2: b[0], y2: b[1], stroke, 'stroke-width': width, ...extra}));
    };
    if (state.trail) {
      const points = [];
      for (let f = 0; f < frames.count && frames.bodyCount > 0; ++f) points.push(this.flat(frames.poseOf(f, 0)).join(','));
      out.push(node('polyline', {points: points.join(' '), fill: 'none', stroke: theme.trail, 'stroke-width': width}));
    }
    if (state.cones) {
      for (const {point, normal} of frames.contacts(state.frame)) {
        segment(point, Array.from(point).map((v, k) => v + 0.13 * normal[k]), theme.contact, {});
      }
    }
    const com = Array.from(frames.comOf(state.frame));
    segment(com, [com[0], com[1], this.survey.ground], theme.com, {'stroke-dasharray': 4 * width});
    const [u, v] = this.flat(com);
    out.push(node('circle', {cx: u, cy: v, r: 0.035, fill: theme.paper, stroke: theme.com, 'stroke-width': 2 * width}));
    return out;
  }
}

function node(name, attributes) {
  const item = document.createElementNS(NS, name);
  for (const key of Object.keys(attributes)) item.setAttribute(key, attributes[key]);
  return item;
}
