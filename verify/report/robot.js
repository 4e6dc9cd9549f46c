// The robot's bodies, its ghosts, and the path of its root.
import * as THREE from 'three';

import {colour} from './scene.js';
import {geometryOf, outlineOf} from './shapes.js';

const GHOSTS = 6;

export class RobotModel {
  constructor(data, theme) {
    this.data = data;
    this.group = new THREE.Group();
    this.ghosts = new THREE.Group();
    this.pickable = [];
    this.materials = {
      plain: new THREE.MeshStandardMaterial({roughness: 0.62, metalness: 0.02}),
      touching: new THREE.MeshStandardMaterial({roughness: 0.62, metalness: 0.02}),
      marked: new THREE.MeshStandardMaterial({roughness: 0.62, metalness: 0.02}),
      outline: new THREE.LineBasicMaterial({transparent: true, opacity: 0.55}),
      ghost: new THREE.MeshStandardMaterial({roughness: 1, transparent: true, opacity: 0.16}),
    };
    this.bodies = data.bodies.map((body, index) => this.build(body, index));
    this.bodies.forEach((body) => this.group.add(body));
    this.buildGhosts();
    this.trail = this.buildTrail();
    this.setTheme(theme);
  }

  build(body, index) {
    const group = new THREE.Group();
    for (const link of body.links) {
      for (const shape of link.shapes) {
        const geometry = geometryOf(shape);
        const mesh = new THREE.Mesh(geometry, this.materials.plain);
        mesh.castShadow = mesh.receiveShadow = true;
        mesh.position.fromArray(shape.p);
        mesh.quaternion.fromArray(shape.q);
        mesh.userData = {title: link.name, body: index, kind: shape.kind,
          detail: link.name === body.name ? '' : `body ${body.name}`};
        this.pickable.push(mesh);
        group.add(mesh);
        const outline = outlineOf(shape, geometry);
        if (outline) mesh.add(new THREE.LineSegments(outline, this.materials.outline));
      }
    }
    return group;
  }

  buildGhosts() {
    const {frames} = this.data;
    const shown = new Set();
    for (let i = 0; i < GHOSTS; ++i) shown.add(frames.nearest(i / (GHOSTS - 1)));
    for (const frame of shown) {
      this.bodies.forEach((body, index) => {
        const ghost = new THREE.Group();
        for (const mesh of body.children) {
          const copy = new THREE.Mesh(mesh.geometry, this.materials.ghost);
          copy.position.copy(mesh.position);
          copy.quaternion.copy(mesh.quaternion);
          ghost.add(copy);
        }
        const pose = frames.poseOf(frame, index);
        ghost.position.fromArray(pose);
        ghost.quaternion.fromArray(pose, 3);
        this.ghosts.add(ghost);
      });
    }
  }

  buildTrail() {
    const {frames} = this.data;
    const points = new Float32Array(3 * frames.count);
    for (let f = 0; f < frames.count; ++f) {
      if (frames.bodyCount > 0) points.set(frames.poseOf(f, 0).subarray(0, 3), 3 * f);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(points, 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(3 * frames.count), 3));
    const group = new THREE.Group();
    const options = {vertexColors: THREE.VertexColors, transparent: true};
    this.trailGeometry = geometry;
    group.add(new THREE.Line(geometry, new THREE.LineBasicMaterial(options)));
    group.add(new THREE.Points(geometry, new THREE.PointsMaterial(
        {...options, size: 3, sizeAttenuation: false, depthTest: false})));
    group.children[1].renderOrder = 4;
    return group;
  }

  setTheme(theme) {
    this.theme = theme;
    this.materials.plain.color = colour(theme.robot);
    this.materials.touching.color = colour(theme.robot).lerp(colour(theme.contact), 0.42);
    this.materials.marked.color = colour(theme.fails);
    this.materials.outline.color = colour(theme.robotEdge);
    this.materials.ghost.color = colour(theme.accent);
    const colours = this.trailGeometry.attributes.color;
    const byVerdict = {holds: colour(theme.trail), fails: colour(theme.fails), undecided: colour(theme.undecided)};
    for (let f = 0; f < colours.count; ++f) byVerdict[this.data.frames.verdictName(f)].toArray(colours.array, 3 * f);
    colours.needsUpdate = true;
  }

  // Between two frames each body is interpolated on its own: good enough to look at.
  place(t, frame) {
    const {frames} = this.data;
    const {before, after, weight} = frames.around(t);
    const touching = new Set(frames.contacts(frame).map((contact) => contact.body));
    const marked = new Set(frames.marked(frame));
    const target = new THREE.Quaternion();
    this.bodies.forEach((body, index) => {
      const from = frames.poseOf(before, index), to = frames.poseOf(after, index);
      body.position.fromArray(from).lerp(new THREE.Vector3().fromArray(to), weight);
      body.quaternion.fromArray(from, 3).slerp(target.fromArray(to, 3), weight);
      const material = marked.has(index) ? this.materials.marked :
        touching.has(index) ? this.materials.touching : this.materials.plain;
      for (const mesh of body.children) mesh.material = material;
    });
  }
}
