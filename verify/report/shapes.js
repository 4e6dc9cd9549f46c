// Geometry of the shape kinds, in the shape's own frame (z along cylinders and capsules).
import * as THREE from 'three';

export function geometryOf(shape) {
  switch (shape.kind) {
    case 'box': return new THREE.BoxBufferGeometry(...shape.size);
    case 'sphere': return new THREE.SphereBufferGeometry(shape.radius, 40, 24).rotateX(Math.PI / 2);
    case 'cylinder':
      return new THREE.CylinderBufferGeometry(shape.radius, shape.radius, shape.length, 48)
          .rotateX(Math.PI / 2);
    case 'capsule': return capsule(shape.radius, shape.length);
    default: return mesh(shape);
  }
}

// A line turned round the axis: half circle, wall, half circle.
function capsule(radius, length) {
  const profile = [];
  const steps = 12;
  for (const end of [-1, 1]) {
    for (let i = 0; i <= steps; ++i) {
      const angle = end < 0 ? -Math.PI / 2 * (1 - i / steps) : Math.PI / 2 * i / steps;
      profile.push(new THREE.Vector2(Math.max(1e-9, radius * Math.cos(angle)),
                                     end * length / 2 + radius * Math.sin(angle)));
    }
  }
  return new THREE.LatheBufferGeometry(profile, 40).rotateX(Math.PI / 2);
}

// Normals are shared across edges flatter than this, so that round parts look round.
const SMOOTH = Math.cos(32 * Math.PI / 180);

function mesh({vertices, triangles}) {
  const count = triangles.length;
  const faceNormals = new Float32Array(count);
  const atVertex = new Map();
  const a = new THREE.Vector3(), b = new THREE.Vector3(), c = new THREE.Vector3();
  const keyOf = (v) => `${vertices[3 * v]},${vertices[3 * v + 1]},${vertices[3 * v + 2]}`;
  const keys = [];
  for (let v = 0; 3 * v < vertices.length; ++v) keys.push(keyOf(v));
  for (let t = 0; t < count; t += 3) {
    a.fromArray(vertices, 3 * triangles[t]);
    b.fromArray(vertices, 3 * triangles[t + 1]).sub(a);
    c.fromArray(vertices, 3 * triangles[t + 2]).sub(a);
    b.cross(c).normalize().toArray(faceNormals, t);
    for (let k = 0; k < 3; ++k) {
      const key = keys[triangles[t + k]];
      if (!atVertex.has(key)) atVertex.set(key, []);
      atVertex.get(key).push(t);
    }
  }
  const positions = new Float32Array(3 * count), normals = new Float32Array(3 * count);
  for (let t = 0; t < count; t += 3) {
    a.fromArray(faceNormals, t);
    for (let k = 0; k < 3; ++k) {
      const v = triangles[t + k];
      c.set(0, 0, 0);
      for (const other of atVertex.get(keys[v])) {
        b.fromArray(faceNormals, other);
        if (b.dot(a) > SMOOTH) c.add(b);
      }
      c.normalize().toArray(normals, 3 * (t + k));
      positions.set(vertices.subarray(3 * v, 3 * v + 3), 3 * (t + k));
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new THREE.BufferAttribute(normals, 3));
  return geometry;
}

// The lines that make an edge visible; none for round shapes.
export function outlineOf(shape, geometry) {
  if (shape.kind === 'sphere' || shape.kind === 'capsule') return null;
  if (geometry.attributes.position.count > 60000) return null;
  const outline = new THREE.EdgesGeometry(geometry, 32);
  return outline.attributes.position.count > 0 ? outline : null;
}
