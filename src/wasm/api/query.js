/* A snapshot of a scene for rays. See "ray queries" and "ray trees and fans" in cuvette.h.
 *
 * exports: Query, rayNumbers(ray)
 * A ray is {origin, direction, reach}; origin and direction are arrays of 3 numbers; reach 0, or no reach: no limit. */

import { badInput } from './errors.js';
import { Handle } from './handle.js';

export function rayNumbers(ray) {
  const numbers = [...(ray?.origin ?? []), ...(ray?.direction ?? []), ray?.reach ?? 0];
  if (numbers.length !== 7)
    throw badInput('a ray has no origin or no direction', 'give {origin: [x, y, z], direction: [x, y, z]}');
  return numbers;
}

export class Query extends Handle {
  static kind = 'Query';
  #memory;

  constructor(memory, address) {
    super(address, () => memory.call('cuvette_query_destroy', address));
    this.#memory = memory;
  }

  /* The ray of the camera through a point of the image: 0.5, 0.5 is the centre of the first pixel. */
  cameraRay(x, y) {
    return this.#memory.json('wasm_query_camera_ray', this.at, x, y);
  }

  /* The nearest interface of each ray; distance is null for none. */
  nearest(rays) {
    return this.#memory.json('wasm_query_nearest', this.at, rays.flatMap(rayNumbers), rays.length);
  }

  /* The name of the solid that contains a point; null for none. */
  medium(point) {
    return this.#memory.json('wasm_query_medium', this.at, point).solid;
  }

  /* The tree of a ray or of a pixel, {pixel: [x, y]}, as `cuvette trace --json` writes it. */
  trace(ray) {
    return ray.pixel
      ? this.#memory.json('wasm_query_trace_pixel', this.at, ...ray.pixel)
      : this.#memory.json('wasm_query_trace', this.at, rayNumbers(ray));
  }

  /* rule: {from, to, normal, rays, width or spread_deg}. */
  fan({ from, to, normal = [0, 0, 0], rays = 11, width = 0, spread_deg = 0 }) {
    return this.#memory.json('wasm_query_fan', this.at, [...from, ...to, ...normal, rays, width, spread_deg]);
  }
}
