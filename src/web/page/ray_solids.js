/* The outlines of simple solids, seen along any direction: of convex ones the hull of their corners and rims.
 * exports: solidPoints(lab) -> [{name, points: [[[x,y,z]..]..]}]    for each solid, the points of each of its convex
 *                                                                   parts, in scene units;
 *          hull(points) -> points                                   the convex hull of [u, v], counter-clockwise
 * Planes have no outline and meshes no cheap one: they are left out. */

import { add } from './ray_vectors.js';

const RIM = 48;

function circle(radius, m, y) {
  return Array.from({ length: RIM }, (_, k) => {
    const angle = (2 * Math.PI * k) / RIM;
    return [radius * Math.cos(angle), y, (radius / m) * Math.sin(angle)];
  });
}

const tube = (radius, m, low, high) => [...circle(radius, m, low), ...circle(radius, m, high)];

function ball(radius) {
  const points = [];
  for (let k = -6; k <= 6; k++) {
    const angle = (k * Math.PI) / 12;
    points.push(...circle(radius * Math.cos(angle), 1, radius * Math.sin(angle)));
  }
  return points;
}

function box([x, y, z]) {
  const points = [];
  for (const i of [-0.5, 0.5])
    for (const j of [-0.5, 0.5]) for (const k of [-0.5, 0.5]) points.push([i * x, j * y, k * z]);
  return points;
}

const shapes = {
  box: (of) => [box(of('size'))],
  sphere: (of) => [ball(of('radius'))],
  cylinder: (of) => [tube(of('radius'), of('m') || 1, 0, of('height'))],
  cup: (of) => [
    tube(of('radius'), of('m') || 1, 0, of('height')),
    tube(of('inner_radius'), of('m') || 1, of('floor'), of('height')),
  ],
};

/* About x, then y, then z, as the scene says it. */
function turn(point, [a, b, c]) {
  const turned = (p, i, j, degrees) => {
    const [sin, cos] = [Math.sin((degrees * Math.PI) / 180), Math.cos((degrees * Math.PI) / 180)];
    const q = [...p];
    q[i] = cos * p[i] - sin * p[j];
    q[j] = sin * p[i] + cos * p[j];
    return q;
  };
  return turned(turned(turned(point, 1, 2, a), 2, 0, b), 0, 1, c);
}

export function solidPoints(lab) {
  const solids = [];
  for (const object of lab.scene?.objects || []) {
    const of = (name) => lab.param(`${object.name}.${name}`)?.value;
    const position = of('position');
    if (object.kind !== 'solid' || !shapes[object.shape] || !position || of('visible') === 'off') continue;
    const parts = shapes[object.shape](of).map((points) =>
      points.map((point) => add(turn(point, of('rotation') || [0, 0, 0]), position)),
    );
    solids.push({ name: object.name, points: parts });
  }
  return solids;
}

/* Andrew's monotone chain. */
export function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const chain = (list) => {
    const kept = [];
    for (const p of list) {
      while (kept.length > 1 && cross(kept[kept.length - 2], kept[kept.length - 1], p) <= 0) kept.pop();
      kept.push(p);
    }
    return kept.slice(0, -1);
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

const cross = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
