/* The outlines of simple solids, seen along any direction: for convex parts the hull of their corners and rims.
 * exports: solidPoints(lab) -> [{name, points: [[[x,y,z]..]..]}]    for each solid, the points of each of its convex
 *                                                                   parts, in scene units;
 *          hull(points) -> points                                   the convex hull of [u, v], counter-clockwise
 * Solids without outline (planes) or without a cheap one (meshes) are omitted. */

import { add } from '../shared/vectors.js';

const RIM = 48; /* corners that draw a circle */

/* A ring of the API's outlines: height, half axes, number of corners (0: round) and angle of the first corner. */
function ring([y, x, z, corners, from]) {
  const count = corners || RIM;
  return Array.from({ length: count }, (_, k) => {
    const angle = (from / 180) * Math.PI + (2 * Math.PI * k) / count;
    return [x * Math.cos(angle), y, z * Math.sin(angle)];
  });
}

/* Rotates about x, then y, then z, the order of the scene's rotation. */
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
  return Object.entries(lab.scene?.outlines || {}).map(([name, parts]) => {
    const of = (row) => lab.param(`${name}.${row}`)?.value || [0, 0, 0];
    const placed = (point) => add(turn(point, of('rotation')), of('position'));
    return { name, points: parts.map((rings) => rings.flatMap((each) => ring(each).map(placed))) };
  });
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
