// Directions of view, shared by the camera and by the flat drawing. z is up.
export const VIEWS = {
  front: [1, 0, 0],
  side: [0, -1, 0],
  top: [0, 0, 1],
  iso: [0.6, -1, 0.5],
};

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((value) => value / Math.hypot(...a));

// Corners that the view "iso" chooses from: the first from which the least of the robot is hidden.
export const CORNERS = [[0.6, -1, 0.5], [0.6, 1, 0.5], [-0.6, -1, 0.5], [-0.6, 1, 0.5]];

// right, up: axes of the picture; back: towards the eye.
export function axesOfView(name) {
  const back = unit(VIEWS[name]);
  const right = name === 'top' ? [1, 0, 0] : unit(cross([0, 0, 1], back));
  return {right, up: cross(back, right), back};
}

// Corners of the convex hull of points [u, v], counterclockwise (Andrew's monotone chain).
export function hullOf(points) {
  const sorted = points.slice().sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const half = (input) => {
    const out = [];
    for (const p of input) {
      while (out.length > 1 && turn(out[out.length - 2], out[out.length - 1], p) <= 0) out.pop();
      out.push(p);
    }
    out.pop();
    return out;
  };
  return sorted.length < 3 ? sorted : half(sorted).concat(half(sorted.reverse()));
}
