// What holds the robot up: contacts with normals and friction cones, centre of mass, support region.
import * as THREE from 'three';

import {colour} from './scene.js';

const CONE_HEIGHT = 0.13;
const COM_RADIUS = 0.036;

// The marks lie inside the robot and are drawn over it; obstacles hide contacts, nothing hides the CoM.
const MARK = {transparent: true, depthWrite: false};
const OVERLAY = {...MARK, depthTest: false};

export class BalanceMarks {
  constructor(data, survey, theme) {
    this.data = data;
    this.ground = survey.ground;
    this.group = new THREE.Group();
    this.contacts = new THREE.Group();
    this.materials = {
      cone: new THREE.MeshBasicMaterial({...MARK, opacity: 0.13, side: THREE.DoubleSide}),
      maybe: new THREE.MeshBasicMaterial({...MARK, opacity: 0.07, side: THREE.DoubleSide}),
      normal: new THREE.LineBasicMaterial({...MARK, opacity: 0.9}),
      point: new THREE.MeshBasicMaterial({...MARK}),
      drop: new THREE.LineDashedMaterial({...OVERLAY, opacity: 0.75, dashSize: 0.025, gapSize: 0.018}),
      region: new THREE.MeshBasicMaterial({transparent: true, opacity: 0.22, depthWrite: false, side: THREE.DoubleSide}),
      rim: new THREE.LineBasicMaterial({transparent: true, opacity: 0.95}),
      disc: new THREE.LineBasicMaterial({transparent: true, opacity: 0.9}),
    };
    this.shapes = {
      point: new THREE.SphereBufferGeometry(0.0095, 16, 12),
      normal: new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(0, 0, CONE_HEIGHT)]),
      rim: new THREE.BufferGeometry().setFromPoints(circle(64)),
      cones: new Map(),
    };
    this.com = this.buildCom();
    this.drop = new THREE.Line(new THREE.BufferGeometry(), this.materials.drop);
    this.foot = new THREE.Group();
    this.group.add(this.foot);
    this.overlay = new THREE.Group();
    this.overlay.add(this.contacts, this.com, this.drop);
    this.setTheme(theme);
  }

  // The surveyor's mark: a ball whose eight octants alternate.
  buildCom() {
    const geometry = new THREE.SphereBufferGeometry(COM_RADIUS, 32, 24).toNonIndexed();
    const at = geometry.attributes.position;
    const colours = new Float32Array(3 * at.count);
    for (let i = 0; i < at.count; i += 3) {
      const middle = [0, 1, 2].map((k) => at.array[3 * i + k] + at.array[3 * i + 3 + k] + at.array[3 * i + 6 + k]);
      const tone = middle[0] * middle[1] * middle[2] > 0 ? 1 : 0.02;
      colours.fill(tone, 3 * i, 3 * i + 9);
    }
    geometry.setAttribute('color', new THREE.BufferAttribute(colours, 3));
    const ball = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({...OVERLAY, vertexColors: THREE.VertexColors}));
    const rim = new THREE.Mesh(new THREE.SphereBufferGeometry(1.13 * COM_RADIUS, 32, 24),
        new THREE.MeshBasicMaterial({...OVERLAY}));
    ball.renderOrder = 21;
    rim.renderOrder = 20;
    this.comRim = rim.material;
    const group = new THREE.Group();
    group.add(rim, ball);
    return group;
  }

  setTheme(theme) {
    this.theme = theme;
    for (const name of ['cone', 'maybe', 'normal', 'point']) this.materials[name].color = colour(theme.contact);
    this.materials.maybe.color = colour(theme.undecided);
    this.materials.drop.color = colour(theme.com);
    this.materials.region.color = this.materials.rim.color = colour(theme.margin);
    this.materials.disc.color = colour(theme.com);
    this.comRim.color = colour(theme.dark ? '#0c0d0f' : '#ffffff');
  }

  coneGeometry(friction) {
    const key = friction.toFixed(3);
    if (!this.shapes.cones.has(key)) {
      // Steep cones are cut shorter, so that all are of about the same size.
      const height = CONE_HEIGHT / Math.max(1, Math.hypot(1, friction) / 1.3);
      const cone = new THREE.ConeBufferGeometry(friction * height, height, 40, 1, true);
      cone.rotateX(-Math.PI / 2).translate(0, 0, height / 2);
      this.shapes.cones.set(key, {cone, height, radius: friction * height});
    }
    return this.shapes.cones.get(key);
  }

  addContact(contact) {
    const mark = new THREE.Group();
    const {cone, height, radius} = this.coneGeometry(contact.friction);
    const parts = [new THREE.Mesh(cone, contact.certain ? this.materials.cone : this.materials.maybe)];
    const rim = new THREE.LineLoop(this.shapes.rim, this.materials.normal);
    rim.scale.set(radius, radius, 1);
    rim.position.z = height;
    if (contact.certain) parts.push(rim);
    parts.push(new THREE.Line(this.shapes.normal, this.materials.normal));
    parts.push(new THREE.Mesh(this.shapes.point, this.materials.point));
    parts.forEach((part, i) => {
      part.renderOrder = 10 + i;
      mark.add(part);
    });
    mark.position.fromArray(contact.point);
    mark.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1),
        new THREE.Vector3().fromArray(contact.normal).normalize());
    this.contacts.add(mark);
  }

  place(frame) {
    const {frames} = this.data;
    this.contacts.remove(...this.contacts.children);
    for (const contact of frames.contacts(frame)) this.addContact(contact);
    const [x, y, z] = frames.comOf(frame);
    this.com.position.set(x, y, z);
    this.drop.geometry.dispose();
    this.drop.geometry = new THREE.BufferGeometry().setFromPoints(
        [new THREE.Vector3(x, y, z), new THREE.Vector3(x, y, this.ground)]);
    this.drop.computeLineDistances();
    this.drop.renderOrder = 9;
    this.placeFoot(frame, x, y);
  }

  // On the ground: the region the CoM may move in, its projection, the disc of the margin.
  placeFoot(frame, x, y) {
    for (const part of this.foot.children) part.geometry.dispose();
    this.foot.remove(...this.foot.children);
    const z = this.ground + 0.004;
    const support = this.data.frames.support(frame);
    const corners = [];
    for (let i = 0; i < support.length; i += 2) corners.push(new THREE.Vector2(support[i], support[i + 1]));
    if (corners.length > 2) {
      const region = new THREE.Mesh(new THREE.ShapeBufferGeometry(new THREE.Shape(corners)), this.materials.region);
      region.position.z = z;
      this.foot.add(region);
    }
    if (corners.length > 1) {
      this.foot.add(new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(
          corners.map((p) => new THREE.Vector3(p.x, p.y, z + 0.001))), this.materials.rim));
    }
    const arms = [[-1, 0], [1, 0], [0, -1], [0, 1]].map(([i, j]) => new THREE.Vector3(x + 0.03 * i, y + 0.03 * j, z + 0.002));
    this.foot.add(new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(arms), this.materials.disc));
    const margin = this.data.frames.comMargin[frame];
    if (margin > 0 && margin < 5) {
      const ring = circle(72).map((p) => new THREE.Vector3(x + margin * p.x, y + margin * p.y, z + 0.002));
      this.foot.add(new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(ring), this.materials.disc));
    }
  }
}

function circle(count) {
  const points = [];
  for (let i = 0; i < count; ++i) {
    const angle = 2 * Math.PI * i / count;
    points.push(new THREE.Vector3(Math.cos(angle), Math.sin(angle), 0));
  }
  return points;
}
