/* The plane of a section and its window on the screen. Pure functions and numbers, without page and server.
 *
 * A plane is {origin, right, up, normal} of /api/section: unit vectors, and the point nearest to the scene's origin. A
 * point of it is [u, v] in scene units, u to the right and v up.
 *
 * exports:
 *   flat(plane, point) -> [u, v, w]      w: the distance from the plane, along its normal
 *   placed(plane, u, v) -> [x, y, z]     the vector of u and v, without the origin
 *   axisName(vector) -> 'x', '-z' or null         null for a direction that is no axis of the world
 *   turnAbout(plane, degrees) -> [x, y, z]        the rotation from right to up, as angles about the world's x, y, z in
 *                                        this order
 *   createPort() -> port                 {u, v: the centre; scale: pixels per scene unit; width, height: pixels}
 *     port.x(u), port.y(v), port.at(x, y) -> [u, v], port.extent(margin) -> [u0, u1, v0, v1], port.fit(extent, top),
 *     port.zoom(factor, x, y), port.pan(dx, dy)
 *   niceStep(least) -> the smallest of 1, 2, 5 times a power of ten that is not below */

import { dot } from '../shared/vectors.js';

export function flat({ origin, right, up, normal }, point) {
  const d = point.map((x, axis) => x - origin[axis]);
  return [dot(d, right), dot(d, up), dot(d, normal)];
}

export const placed = ({ right, up }, u, v) => right.map((x, axis) => u * x + v * up[axis]);

export function axisName(vector) {
  const at = vector.findIndex((x) => Math.abs(x) > 1 - 1e-9);
  return at < 0 ? null : `${vector[at] < 0 ? '-' : ''}${'xyz'[at]}`;
}

export function turnAbout({ right, up, normal }, degrees) {
  const [sin, cos] = [Math.sin((degrees * Math.PI) / 180), Math.cos((degrees * Math.PI) / 180)];
  const entry = (i, j) =>
    cos * (right[i] * right[j] + up[i] * up[j]) + sin * (up[i] * right[j] - right[i] * up[j]) + normal[i] * normal[j];
  const axis = normal.findIndex((x) => Math.abs(x) > 1 - 1e-9);
  if (axis >= 0) {
    const [i, j] = [(axis + 1) % 3, (axis + 2) % 3];
    const sense = Math.sign(right[i] * up[j] - right[j] * up[i]);
    return [0, 1, 2].map((each) => (each === axis ? sense * degrees : 0));
  }
  const angles = [
    Math.atan2(entry(2, 1), entry(2, 2)),
    Math.asin(Math.min(1, Math.max(-1, -entry(2, 0)))),
    Math.atan2(entry(1, 0), entry(0, 0)),
  ];
  return angles.map((angle) => (angle * 180) / Math.PI);
}

export function niceStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((factor) => factor * power).find((step) => step >= least * (1 - 1e-9));
}

const LARGEST = 1e7;
const SMALLEST = 1e-4;

export function createPort() {
  const port = { u: 0, v: 0, scale: 100, width: 0, height: 0, x, y, at, extent, fit, zoom, pan };
  return port;

  function x(u) {
    return port.width / 2 + (u - port.u) * port.scale;
  }

  function y(v) {
    return port.height / 2 - (v - port.v) * port.scale;
  }

  function at(px, py) {
    return [port.u + (px - port.width / 2) / port.scale, port.v - (py - port.height / 2) / port.scale];
  }

  /* margin: as a fraction of the sides. */
  function extent(margin = 0) {
    const [halfU, halfV] = [port.width, port.height].map((side) => ((0.5 + margin) * side) / port.scale);
    return [port.u - halfU, port.u + halfU, port.v - halfV, port.v + halfV];
  }

  /* top: pixels that stay free above. */
  function fit([u0, u1, v0, v1], top = 0) {
    if (port.width && port.height > top) port.scale = Math.min(port.width / (u1 - u0), (port.height - top) / (v1 - v0));
    port.u = (u0 + u1) / 2;
    port.v = (v0 + v1 + top / port.scale) / 2;
  }

  function zoom(factor, px = port.width / 2, py = port.height / 2) {
    const [u, v] = at(px, py);
    port.scale = Math.min(LARGEST, Math.max(SMALLEST, port.scale * factor));
    port.u = u - (px - port.width / 2) / port.scale;
    port.v = v + (py - port.height / 2) / port.scale;
  }

  function pan(dx, dy) {
    port.u -= dx / port.scale;
    port.v += dy / port.scale;
  }
}
