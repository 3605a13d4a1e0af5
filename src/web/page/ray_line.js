/* Lines of rays within a frame. A line has `from` and `along`, [x, y, z], and `end`: its points are from + s along for
 * 0 <= s <= end. Where rays end is the program's rule, `far_end` of the API (render/inspect/ray_line.h): a ray that
 * leaves the scene has no end (Infinity), and its line runs to the edge of the frame.
 *
 * exports:
 *   lineTo(from, farEnd), lineBetween(from, to) -> line
 *   pointAt(line, s) -> [x, y, z]
 *   seenLine(line, camera, {width, height}, frame) -> [[x, y, s], [x, y, s]] or null    the part that the camera of
 *                                the state sees in the frame, in pixels of an image of that size
 *   flatLine(line, {u, v}, frame) -> [[u, v], [u, v]] or null    the part whose projection onto the axes is in it
 *   frame: {left, top, right, bottom}; of flatLine v increases from bottom to top */

import { add, dot, length, minus, times } from './ray_vectors.js';

const NEAR = 1e-6; /* the constants of render/inspect/ray_line.c */
const NEAR_OF_EYE = 1e-9;
const ALONG_THE_VIEW = 1e-12;

export const lineBetween = (from, to) => ({ from, along: minus(to, from), end: 1 });

export function lineTo(from, [x, y, z, w]) {
  return w ? lineBetween(from, [x, y, z]) : { from, along: [x, y, z], end: Infinity };
}

export const pointAt = ({ from, along }, s) => add(from, times(along, s));

/* Where each start + s slope >= 0, from 0 to end: [first, last], or null (Liang and Barsky). */
function within(end, conditions) {
  let [first, last] = [0, end];
  for (const [start, slope] of conditions) {
    if (slope === 0 && start < 0) return null;
    if (slope > 0) first = Math.max(first, -start / slope);
    if (slope < 0) last = Math.min(last, -start / slope);
  }
  return first < last ? [first, last] : null;
}

/* Of a parallel view: a line along it is a point. */
const flattened = ([x, y, z]) => (Math.hypot(x, y) <= ALONG_THE_VIEW * Math.abs(z) ? [0, 0, z] : [x, y, z]);

export function seenLine(line, camera, { width, height }, frame) {
  const { eye, forward, right, up, half_width: halfWidth, half_height: halfHeight, parallel } = camera;
  const offset = minus(line.from, eye);
  const inView = (v) => [dot(v, right), dot(v, up), dot(v, forward)];
  const inImage = ([x, y, z]) => [x / halfWidth, y / halfHeight, z];
  const from = inImage(inView(offset));
  const along = inImage(parallel ? flattened(inView(line.along)) : inView(line.along));
  const near = parallel ? 0 : NEAR * length(offset) + NEAR_OF_EYE * length(eye);
  const [spread, widening] = parallel ? [1, 0] : [from[2], along[2]];
  const edge = (axis, side, sign) => [sign * (from[axis] - side * spread), sign * (along[axis] - side * widening)];
  const found = within(line.end, [
    [from[2] - near, along[2]],
    edge(0, (2 * frame.left) / width - 1, 1),
    edge(0, (2 * frame.right) / width - 1, -1),
    edge(1, 1 - (2 * frame.bottom) / height, 1),
    edge(1, 1 - (2 * frame.top) / height, -1),
  ]);
  /* In perspective the direction decides at the vanishing point, and at the eye. */
  const image = (s) => {
    const point = add(from, times(along, Number.isFinite(s) ? s : 0));
    const [x, y, z] = !parallel && (!Number.isFinite(s) || point[2] <= 0) ? along : point;
    const size = parallel ? 1 : z;
    return [((1 + x / size) / 2) * width, ((1 - y / size) / 2) * height, s];
  };
  return found && found.map(image);
}

export function flatLine(line, { u, v }, { left, top, right, bottom }) {
  const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const [x, y] = [dot(line.from, u), dot(line.from, v)];
  const along = flattened([dot(line.along, u), dot(line.along, v), dot(line.along, normal)]);
  const found = within(line.end, [
    [x - left, along[0]],
    [right - x, -along[0]],
    [y - bottom, along[1]],
    [top - y, -along[1]],
  ]);
  return found && found.map((s) => (Number.isFinite(s) ? [x + s * along[0], y + s * along[1]] : [x, y]));
}
