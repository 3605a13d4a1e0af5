/* Vectors of three numbers. exports: add, minus, times, dot, length, unit, mean, spreadAt */

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const mean = (a) => (a[0] + a[1] + a[2]) / 3;

/* null for a vector without direction */
export function unit(a) {
  const size = length(a);
  return size > 0 ? times(a, 1 / size) : null;
}

/* Scene units per unit of the image plane, the unit of state.camera.half_width, at a depth. */
export const spreadAt = (camera, depth) => (camera.parallel ? 1 : depth);
