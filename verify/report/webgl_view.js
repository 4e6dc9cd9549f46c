// The drawing in 3-D. Draws when something changed, not all the time.
import * as THREE from 'three';

import {BalanceMarks} from './balance.js';
import {CameraRig} from './camera.js';
import {addNotice} from './notice.js';
import {CORNERS} from './projection.js';
import {RobotModel} from './robot.js';
import {SceneModel} from './scene.js';

export class WebglView {
  // Throws where the browser gives no WebGL.
  constructor(stage, data, survey, theme) {
    this.name = 'webgl';
    this.stage = stage;
    const canvas = document.createElement('canvas');
    // The first attempt is ours, so that its failure stays off the console.
    const attributes = {alpha: true, antialias: true, depth: true, stencil: false, premultipliedAlpha: true};
    const context = canvas.getContext('webgl', attributes) || canvas.getContext('experimental-webgl', attributes);
    if (!context) throw new Error('no WebGL');
    this.renderer = new THREE.WebGLRenderer({canvas, context, alpha: true, antialias: true});
    this.renderer.gammaOutput = true;
    this.renderer.gammaFactor = 2.2;
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = THREE.PCFSoftShadowMap;
    this.renderer.setClearColor(0x000000, 0);
    this.renderer.autoClear = false;
    stage.insertBefore(canvas, stage.firstChild);

    this.pending = false;
    this.scene = new THREE.Scene();
    this.model = new SceneModel(data, survey, theme);
    this.robot = new RobotModel(data, theme);
    this.marks = new BalanceMarks(data, survey, theme);
    this.rig = new CameraRig(canvas, survey, () => this.invalidate());
    this.scene.add(this.model.group, this.robot.group, this.robot.ghosts, this.robot.trail, this.marks.group);
    this.scene.add(this.rig.camera);
    this.rig.camera.add(this.model.lamp, this.model.lamp.target);
    this.overlay = new THREE.Scene();
    this.overlay.add(this.model.occluders, this.marks.overlay);
    this.rig.corner = this.clearestCorner(data);
    this.model.lightFrom(this.rig.corner);
    if (this.model.grids.length > 0) addNotice(stage, 'Grid: 0.1 m, 1 m');
    this.onDrawn = () => {};
    this.resize();
    new ResizeObserver(() => this.resize()).observe(stage);
  }

  get element() { return this.renderer.domElement; }

  resize() {
    const width = Math.max(1, this.stage.clientWidth), height = Math.max(1, this.stage.clientHeight);
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const size = [width, height, ratio].join();
    if (size === this.size) return;
    this.size = size;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.rig.resize(width, height);
    // A new size empties the canvas; drawing at once avoids a blank picture.
    this.draw();
  }

  setTheme(theme) {
    for (const part of [this.model, this.robot, this.marks]) part.setTheme(theme);
    this.invalidate();
  }

  setView(name) {
    this.rig.setView(name);
    this.invalidate();
  }
  onUserMove(call) { this.rig.onUserMove(call); }

  show(state) {
    this.robot.place(state.t, state.frame);
    this.marks.place(state.frame);
    this.robot.ghosts.visible = state.ghosts;
    this.robot.trail.visible = state.trail;
    this.marks.contacts.visible = state.cones;
    if (this.xray !== state.xray) this.model.setXray(this.xray = state.xray);
    this.invalidate();
  }

  invalidate() {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.draw();
      this.onDrawn();
    });
  }

  draw() {
    this.renderer.clear();
    this.renderer.render(this.scene, this.rig.camera);
    this.renderer.clearDepth();
    this.renderer.render(this.overlay, this.rig.camera);
  }

  // Looks from each corner at the bodies, at a few instants, and counts those that obstacles hide.
  clearestCorner({frames}) {
    this.scene.updateMatrixWorld();
    const ray = new THREE.Raycaster();
    const small = this.model.pickable.filter((mesh) => !mesh.material.isShaderMaterial &&
      mesh.geometry.attributes.position.count < 30000);
    const target = new THREE.Vector3(), eye = new THREE.Vector3();
    const hidden = CORNERS.map((corner) => {
      eye.fromArray(this.rig.eyeAt(corner, this.rig.fittingDistance()));
      let count = 0;
      for (const t of [0, 0.25, 0.5, 0.75, 1]) {
        const frame = frames.nearest(t * frames.t[frames.count - 1]);
        for (let b = 0; b < frames.bodyCount; b += Math.ceil(frames.bodyCount / 16)) {
          target.fromArray(frames.poseOf(frame, b));
          ray.far = target.distanceTo(eye);
          ray.set(eye, target.sub(eye).normalize());
          if (ray.intersectObjects(small).length > 0) ++count;
        }
      }
      return count;
    });
    return CORNERS[hidden.indexOf(Math.min(...hidden))];
  }

  // What lies under a point of the stage, in pixels from its corner.
  pick(x, y) {
    const ray = new THREE.Raycaster();
    ray.setFromCamera({x: 2 * x / this.stage.clientWidth - 1, y: 1 - 2 * y / this.stage.clientHeight}, this.rig.camera);
    const hit = ray.intersectObjects([...this.robot.pickable, ...this.model.pickable])[0];
    return hit ? hit.object.userData : null;
  }
}
