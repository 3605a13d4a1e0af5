/* The fan of rays over the image.
 * exports: fanMarks(fan, {stroke(line, class), dot(point, class)}) -> SVG elements
 *   fan: the reply of /api/fan */

import { lineBetween, lineTo } from './ray_line.js';

const CROSSINGS_MAX = 300;

/* Of a path that ends in the scene, the last point is its far end. */
function linesOf({ points, far_end: farEnd }) {
  const lines = points.slice(1).map((point, i) => lineBetween(points[i], point));
  return farEnd[3] ? lines : [...lines, lineTo(points.at(-1), farEnd)];
}

export function fanMarks({ rays, crossings, focus }, { stroke, dot }) {
  return [
    ...rays.flatMap(linesOf).flatMap((line) => stroke(line, 'bench-fan-ray')),
    ...crossings.slice(0, CROSSINGS_MAX).flatMap(({ at }) => dot(at, 'bench-crossing')),
    ...(focus ? dot(focus.at, 'bench-focus') : []),
  ];
}
