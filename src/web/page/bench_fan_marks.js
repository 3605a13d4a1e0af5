/* The fan of rays over the image.
 * exports: fanMarks(fan, reach, {stroke(from, to, class), dot(point, class)}) -> SVG elements
 *   fan: the reply of /api/fan; reach: length of a ray into the sky */

import { add, times } from './ray_vectors.js';

const CROSSINGS_MAX = 300;

export function fanMarks({ rays, crossings, focus }, reach, { stroke, dot }) {
  const paths = rays.map(({ points, direction, end }) =>
    end === 'sky' && direction ? [...points, add(points.at(-1), times(direction, reach))] : points,
  );
  return [
    ...paths.flatMap((points) => points.slice(1).flatMap((point, i) => stroke(points[i], point, 'bench-fan-ray'))),
    ...crossings.slice(0, CROSSINGS_MAX).flatMap(({ at }) => dot(at, 'bench-crossing')),
    ...(focus ? dot(focus.at, 'bench-focus') : []),
  ];
}
