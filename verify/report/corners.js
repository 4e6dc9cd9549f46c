// Points whose convex hull has the outline of a convex shape, in the shape's frame.
export function cornersOf(shape) {
  const out = [];
  if (shape.kind === 'box') {
    const [x, y, z] = shape.size.map((value) => value / 2);
    for (const i of [-x, x]) for (const j of [-y, y]) for (const k of [-z, z]) out.push([i, j, k]);
  } else if (shape.vertices) {
    for (let i = 0; i < shape.vertices.length; i += 3) out.push(Array.from(shape.vertices.subarray(i, i + 3)));
  } else {
    const half = shape.kind === 'sphere' ? 0 : shape.length / 2;
    const rings = shape.kind === 'cylinder' ? [0] : [0, 22.5, 45, 67.5, 90];
    for (const ring of rings) {
      const angle = ring * Math.PI / 180;
      const r = shape.radius * Math.cos(angle), h = half + shape.radius * Math.sin(angle);
      for (let i = 0; i < 24; ++i) {
        const turn = i * Math.PI / 12;
        for (const z of [-h, h]) out.push([r * Math.cos(turn), r * Math.sin(turn), z]);
      }
    }
  }
  return out;
}
