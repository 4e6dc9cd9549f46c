// Perspective camera with z up, turned about the middle of the motion.
import {PerspectiveCamera} from 'three';
import {OrbitControls} from 'orbit-controls';

import {VIEWS} from './projection.js';

export class CameraRig {
  constructor(element, survey, onChange) {
    this.survey = survey;
    this.corner = VIEWS.iso;
    this.camera = new PerspectiveCamera(28, 1, 0.05, 400);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.controls.zoomSpeed = 0.8;
    this.controls.rotateSpeed = 0.7;
    this.controls.minDistance = 0.2;
    this.controls.maxDistance = 60 * survey.radius;
    this.controls.addEventListener('change', onChange);
  }

  // Calls back when the user turns, moves or zooms: the named view no longer holds.
  onUserMove(call) { this.controls.addEventListener('start', call); }

  resize(width, height) {
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  // How far away the eye sees the whole motion.
  fittingDistance() {
    const half = Math.tan(this.camera.fov * Math.PI / 360);
    const fit = half * Math.min(1, this.camera.aspect);
    // A ball of that radius would touch the picture's border; robots are slimmer than their ball.
    return 0.97 * this.survey.radius / Math.sin(Math.atan(fit));
  }

  eyeAt(direction, distance) {
    const length = Math.hypot(...direction);
    return this.survey.centre.map((value, k) => value + distance * direction[k] / length);
  }

  setView(name) {
    const distance = this.fittingDistance();
    const direction = name === 'iso' ? this.corner : VIEWS[name];
    this.controls.target.fromArray(this.survey.centre);
    this.camera.position.fromArray(this.eyeAt(direction, distance));
    // Straight down, "up" is undefined; a breath of -y makes +y the top of the picture.
    if (name === 'top') this.camera.position.y -= 1e-4 * distance;
    this.controls.update();
  }
}
