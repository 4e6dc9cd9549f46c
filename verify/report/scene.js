// Obstacles, the ground's grid, and light.
import * as THREE from 'three';

import {worldHalfspace} from './data.js';
import {geometryOf, outlineOf} from './shapes.js';

// A colour of the style sheet in the linear space in which light is added up.
export function colour(text) { return new THREE.Color(text).convertSRGBToLinear(); }

const GRID_VERTEX = `
varying vec2 plane;
varying vec3 world;
void main() {
  plane = position.xy;
  world = (modelMatrix * vec4(position, 1.0)).xyz;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

// Lines every 0.1 m and 1 m, as wide as a pixel, fading with distance from the middle of the motion.
const GRID_FRAGMENT = `
uniform vec3 fill, line, centre;
uniform float reach;
varying vec2 plane;
varying vec3 world;
float lines(float spacing, float width) {
  vec2 at = plane / spacing;
  vec2 pixel = max(fwidth(at), 1e-6);
  vec2 away = abs(fract(at - 0.5) - 0.5) / pixel;
  float strength = 1.0 - min(min(away.x, away.y) / width, 1.0);
  return strength * (1.0 - smoothstep(0.15, 0.5, max(pixel.x, pixel.y)));
}
void main() {
  float fade = 1.0 - smoothstep(0.25 * reach, reach, distance(world, centre));
  float ink = max(0.32 * lines(0.1, 1.1), 0.85 * lines(1.0, 1.4));
  gl_FragColor = vec4(mix(fill, line, ink), fade * 0.92);
  if (gl_FragColor.a < 0.004) discard;
}`;

export class SceneModel {
  constructor(data, survey, theme) {
    this.survey = survey;
    this.group = new THREE.Group();
    this.pickable = [];
    this.materials = [];
    this.grids = [];
    this.outline = new THREE.LineBasicMaterial({transparent: true, opacity: 0.7});
    // Copies that write depth only: what they hide of the overlay stays hidden.
    this.occluders = new THREE.Group();
    this.depthOnly = new THREE.MeshBasicMaterial({colorWrite: false});
    data.objects.forEach((object, index) => this.addObject(object, index));
    this.addLights();
    this.setTheme(theme);
  }

  addObject(object, index) {
    const material = new THREE.MeshStandardMaterial(
        {roughness: 0.85, metalness: 0, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
    material.userData.shade = (index % 4) * 0.1;
    this.materials.push(material);
    for (const piece of object.pieces) {
      const label = {title: object.name, kind: piece.kind, detail: `friction ${object.friction}`};
      if (piece.kind === 'halfspace') this.addHalfspace(piece, label);
      else this.addPiece(piece, material, label);
    }
  }

  addPiece(piece, shared, label) {
    let material = shared;
    if (piece.kind === 'surface') {
      material = shared.clone();
      material.userData = shared.userData;
      material.side = THREE.DoubleSide;
      this.materials.push(material);
    }
    const geometry = geometryOf(piece);
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.fromArray(piece.p);
    mesh.quaternion.fromArray(piece.q);
    mesh.castShadow = mesh.receiveShadow = true;
    mesh.userData = label;
    this.pickable.push(mesh);
    const occluder = new THREE.Mesh(geometry, this.depthOnly);
    occluder.position.copy(mesh.position);
    occluder.quaternion.copy(mesh.quaternion);
    this.occluders.add(occluder);
    const outline = outlineOf(piece, geometry);
    if (outline) mesh.add(new THREE.LineSegments(outline, this.outline));
    this.group.add(mesh);
  }

  addHalfspace(piece, label) {
    const {normal, distance} = worldHalfspace(piece);
    const n = new THREE.Vector3().fromArray(normal);
    const middle = new THREE.Vector3().fromArray(this.survey.centre);
    middle.addScaledVector(n, distance - middle.dot(n));
    const reach = Math.max(4, 5 * this.survey.radius);
    const geometry = new THREE.PlaneBufferGeometry(2 * reach, 2 * reach);
    // Grid lines stand on multiples of their spacing in the world where the plane is level.
    if (normal[2] > 0.999999) {
      const {x, y} = middle;
      middle.x = Math.round(x);
      middle.y = Math.round(y);
    }
    const grid = new THREE.Mesh(geometry, new THREE.ShaderMaterial({
      vertexShader: GRID_VERTEX, fragmentShader: GRID_FRAGMENT, transparent: true,
      extensions: {derivatives: true}, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2,
      uniforms: {fill: {value: new THREE.Color()}, line: {value: new THREE.Color()},
        centre: {value: middle.clone()}, reach: {value: reach}},
    }));
    const shadow = new THREE.Mesh(geometry, new THREE.ShadowMaterial(
        {opacity: 0.2, polygonOffset: true, polygonOffsetFactor: 1.5, polygonOffsetUnits: 1.5, depthWrite: false}));
    shadow.receiveShadow = true;
    grid.userData = label;
    for (const plane of [grid, shadow]) {
      plane.position.copy(middle);
      plane.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), n);
      this.group.add(plane);
    }
    grid.renderOrder = -2;
    shadow.renderOrder = -1;
    this.grids.push(grid);
    this.pickable.push(grid);
  }

  addLights() {
    const {centre, radius} = this.survey;
    const target = new THREE.Vector3().fromArray(centre);
    this.sky = new THREE.HemisphereLight(0xffffff, 0xffffff, 0.62);
    this.sky.position.set(0, 0, 1);
    this.sun = new THREE.DirectionalLight(0xffffff, 0.62);
    this.sun.target.position.copy(target);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.radius = 2.5;
    this.sun.shadow.bias = -0.0006;
    const box = this.sun.shadow.camera;
    box.left = box.bottom = -1.7 * radius;
    box.right = box.top = 1.7 * radius;
    box.near = 0.1 * radius;
    box.far = 8 * radius;
    this.group.add(this.sky, this.sun, this.sun.target);
    // Goes with the camera, so that no side that is looked at lies in the dark.
    this.lamp = new THREE.DirectionalLight(0xffffff, 0.2);
    this.lamp.position.set(-0.4, 0.6, 1);
  }

  // The sun stands behind the shoulder of somebody in that corner.
  lightFrom([x, y]) {
    const {centre, radius} = this.survey;
    this.sun.position.set(1.8 * x, 1.5 * y, 3.2).multiplyScalar(radius).add(new THREE.Vector3().fromArray(centre));
  }

  setTheme(theme) {
    for (const material of this.materials) {
      material.color = colour(theme.object).lerp(colour(theme.floor), material.userData.shade);
    }
    this.outline.color = colour(theme.objectEdge);
    for (const {material} of this.grids) {
      material.uniforms.fill.value.set(theme.floor);
      material.uniforms.line.value.set(theme.grid);
    }
    this.sky.groundColor.set(theme.dark ? 0x3a3d44 : 0xa9a59c);
    this.sky.intensity = theme.dark ? 0.46 : 0.52;
    this.sun.intensity = theme.dark ? 0.55 : 0.46;
  }

  setXray(on) {
    this.occluders.visible = !on;
    for (const material of this.materials) {
      material.transparent = on;
      material.opacity = on ? 0.25 : 1;
      material.depthWrite = !on;
      material.needsUpdate = true;
    }
  }
}
