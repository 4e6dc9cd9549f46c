// Reads what the C++ side packed: JSON with names, and runs [first, count] of 32-bit words.

import {cornersOf} from './corners.js';

export const VERDICTS = ['holds', 'fails', 'undecided'];

function decode(text) {
  const bytes = atob(text.trim());
  const buffer = new ArrayBuffer(bytes.length);
  const view = new Uint8Array(buffer);
  for (let i = 0; i < bytes.length; ++i) view[i] = bytes.charCodeAt(i);
  return buffer;
}

export function readPageData() {
  const json = JSON.parse(document.getElementById('page-data').textContent);
  const buffer = decode(document.getElementById('page-blob').textContent);
  const floats = ([first, count]) => new Float32Array(buffer, 4 * first, count);
  const words = ([first, count]) => new Uint32Array(buffer, 4 * first, count);

  const openMesh = (shape) => {
    if (!shape.vertices) return shape;
    return {...shape, vertices: floats(shape.vertices), triangles: words(shape.triangles)};
  };
  const bodies = json.bodies.map((body) => ({
    name: body.name,
    links: body.links.map((link) => ({name: link.name, shapes: link.shapes.map(openMesh)})),
  }));
  const objects = json.objects.map((object) => ({...object, pieces: object.pieces.map(openMesh)}));
  return {
    robot: json.robot, bodies, objects, frames: new Frames(json.frames, floats, words, bodies.length),
    length: json.length, waypoints: json.waypoints, held: json.held, worst: json.worst,
  };
}

// The instants of the path; every accessor takes the index of a frame.
class Frames {
  constructor(json, floats, words, bodyCount) {
    this.count = json.count;
    for (const name of ['t', 'edge', 's', 'comMargin', 'clearance', 'verdict', 'com', 'poses']) {
      this[name] = floats(json[name]);
    }
    this.notes = json.notes;
    this.bodyCount = bodyCount;
    this.lists = {};
    for (const name of ['contacts', 'support', 'marked']) {
      this.lists[name] = {items: floats(json[name].items), ends: words(json[name].ends)};
    }
  }

  // The part of a list that belongs to one frame; `stride` floats an item.
  list(name, frame, stride) {
    const {items, ends} = this.lists[name];
    return items.subarray(stride * (frame > 0 ? ends[frame - 1] : 0), stride * ends[frame]);
  }

  contacts(frame) {
    const run = this.list('contacts', frame, 10);
    const out = [];
    for (let i = 0; i < run.length; i += 10) {
      out.push({
        point: run.subarray(i, i + 3), normal: run.subarray(i + 3, i + 6), friction: run[i + 6],
        body: run[i + 7], object: run[i + 8], certain: run[i + 9] > 0,
      });
    }
    return out;
  }
  support(frame) { return this.list('support', frame, 2); }
  marked(frame) { return this.list('marked', frame, 1); }

  comOf(frame) { return this.com.subarray(3 * frame, 3 * frame + 3); }
  poseOf(frame, body) {
    const i = 7 * (frame * this.bodyCount + body);
    return this.poses.subarray(i, i + 7);
  }

  // Frame nearest to time t, the first of several.
  nearest(t) {
    const after = this.firstNotBefore(t);
    if (after === 0) return 0;
    if (after === this.count) return this.firstNotBefore(this.t[this.count - 1]);
    return t - this.t[after - 1] <= this.t[after] - t ? after - 1 : after;
  }
  firstNotBefore(t) {
    let low = 0, high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.t[middle] < t) low = middle + 1; else high = middle;
    }
    return low;
  }
  // The frames round t and the weight of the later one.
  around(t) {
    const after = Math.min(this.firstNotBefore(t), this.count - 1);
    const before = Math.max(0, after - 1);
    const span = this.t[after] - this.t[before];
    const weight = span > 0 ? Math.min(1, Math.max(0, (t - this.t[before]) / span)) : 1;
    return {before, after, weight};
  }
  verdictName(frame) { return VERDICTS[this.verdict[frame]]; }
}

// A ball, in the body's frame, that holds the corners of the body's shapes.
function ballOf(body) {
  const points = [];
  for (const link of body.links) {
    for (const shape of link.shapes) {
      for (const corner of cornersOf(shape)) points.push(rotate(shape.q, corner).map((v, k) => v + shape.p[k]));
    }
  }
  if (points.length === 0) return {centre: [0, 0, 0], radius: 0};
  const centre = [0, 1, 2].map((k) => {
    const values = points.map((point) => point[k]);
    return (values.reduce((a, b) => Math.min(a, b)) + values.reduce((a, b) => Math.max(a, b))) / 2;
  });
  const radius = points.reduce((most, p) => Math.max(most, Math.hypot(...p.map((v, k) => v - centre[k]))), 0);
  return {centre, radius};
}

// Ball round everything the robot does, and the height that counts as the ground below it.
export function surveyMotion(data) {
  const {frames} = data;
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  const add = (x, y, z, pad) => [x, y, z].forEach((value, k) => {
    low[k] = Math.min(low[k], value - pad);
    high[k] = Math.max(high[k], value + pad);
  });
  const balls = data.bodies.map(ballOf);
  for (let f = 0; f < frames.count; ++f) {
    for (let b = 0; b < frames.bodyCount; ++b) {
      const pose = frames.poseOf(f, b);
      const [x, y, z] = rotate(pose.subarray(3), balls[b].centre);
      add(pose[0] + x, pose[1] + y, pose[2] + z, balls[b].radius);
    }
    for (const {point} of frames.contacts(f)) add(point[0], point[1], point[2], 0);
  }
  if (!(low[0] <= high[0])) add(0, 0, 0, 1);
  let ground = low[2];
  for (const object of data.objects) {
    for (const piece of object.pieces) {
      if (piece.kind === 'halfspace') {
        const {normal, distance} = worldHalfspace(piece);
        if (normal[2] > 0.99) ground = distance / normal[2];
      }
    }
  }
  const centre = low.map((value, k) => (value + high[k]) / 2);
  const radius = Math.hypot(...high.map((value, k) => (value - low[k]) / 2));
  return {centre, radius: Math.max(0.3, radius), ground, low, high};
}

export function rotate([x, y, z, w], v) {
  const tx = 2 * (y * v[2] - z * v[1]), ty = 2 * (z * v[0] - x * v[2]), tz = 2 * (x * v[1] - y * v[0]);
  return [v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx];
}

// {x : normal.x <= distance} in the world, normal of length 1.
export function worldHalfspace(piece) {
  const length = Math.hypot(...piece.normal);
  const normal = rotate(piece.q, piece.normal.map((value) => value / length));
  const along = normal[0] * piece.p[0] + normal[1] * piece.p[1] + normal[2] * piece.p[2];
  return {normal, distance: piece.offset / length + along};
}
