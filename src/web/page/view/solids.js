/* The outlines of simple solids, seen along any direction: for convex parts the hull of their corners and rims.
 * exports: solidPoints(lab) -> [{name, points: [[[x,y,z]..]..]}]    for each solid, the points of each of its convex
 *                                                                   parts, in scene units;
 *          solidRings(lab) -> [{name, parts: [[{corners, points: [[x,y,z]..]}..]..]}]   the same by rings; corners: 0
 *                                                                   for a round one
 *          isClear(lab, name)                       whether light passes through the solid
 *          turned(point, [a, b, c]) -> point        rotated about x, then y, then z, by degrees
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
export function turned(point, [a, b, c]) {
  const about = (p, i, j, degrees) => {
    const [sin, cos] = [Math.sin((degrees * Math.PI) / 180), Math.cos((degrees * Math.PI) / 180)];
    const q = [...p];
    q[i] = cos * p[i] - sin * p[j];
    q[j] = sin * p[i] + cos * p[j];
    return q;
  };
  return about(about(about(point, 1, 2, a), 2, 0, b), 0, 1, c);
}

/* A point of a solid's frame in the world; a solid that follows another one is placed in its frame. */
function placed(lab, name, point) {
  const of = (row) => lab.param(`${name}.${row}`)?.value || [0, 0, 0];
  const leader = lab.param(`${name}.follows`)?.value;
  const here = turned(point, of('rotation'));
  return leader ? placed(lab, leader, add(here, of('offset'))) : add(here, of('position'));
}

export function solidRings(lab) {
  return Object.entries(lab.scene?.outlines || {}).map(([name, parts]) => {
    const made = (each) => ({ corners: each[3], points: ring(each).map((point) => placed(lab, name, point)) });
    return { name, parts: parts.map((rings) => rings.map(made)) };
  });
}

export function solidPoints(lab) {
  return solidRings(lab).map(({ name, parts }) => ({
    name,
    points: parts.map((rings) => rings.flatMap(({ points }) => points)),
  }));
}

export function isClear(lab, name) {
  const of = (object) => lab.param(`${object}.transparency`)?.value;
  return (of(name) ?? of(lab.object(name)?.material) ?? 0) > 0;
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
