/* Slimes in motion, and hands that grab them. See "slimes in motion" in cuvette.h.
 *
 * exports: Motion */

import { cancelled } from './errors.js';
import { Handle } from './handle.js';
import { rayNumbers } from './query.js';
import { breathe, BUDGET_MS } from './turns.js';

export class Motion extends Handle {
  static kind = 'Motion';
  #scene;
  #time_s = 0;
  #slice_s = 0.01;
  #hands = new Set();

  constructor(scene) {
    const memory = scene.in();
    const address = memory.handle('cuvette_motion_create', scene.at);
    super(address, () => memory.call('cuvette_motion_destroy', address));
    this.#scene = scene;
  }

  /* The names of the scene's slimes. */
  names() {
    return this.#scene.in().json('wasm_motion_names', this.at);
  }

  state(name) {
    return this.#scene.in().json('wasm_motion_state', this.at, name);
  }

  #step(time_s) {
    const began = performance.now();
    this.#scene.in().check('cuvette_motion_advance', this.at, time_s);
    const ratio = BUDGET_MS / Math.max(1, performance.now() - began);
    this.#slice_s *= Math.min(2, Math.max(0.5, ratio));
    this.#time_s = time_s;
  }

  /* Advances to time_s; while hands hold a slime, in a single step, because hands move in one straight line. */
  async advance(time_s, { progress, signal } = {}) {
    const from_s = this.#time_s;
    while (!this.#hands.size && this.#time_s + this.#slice_s < time_s) {
      if (signal?.aborted) throw cancelled(signal);
      this.#step(this.#time_s + this.#slice_s);
      progress?.((this.#time_s - from_s) / (time_s - from_s));
      await breathe();
    }
    if (signal?.aborted) throw cancelled(signal);
    this.#step(time_s);
    progress?.(1);
  }

  /* {distance, where}, or null for a miss. */
  pick(name, ray) {
    return this.#scene.in().json('wasm_motion_pick', this.at, name, rayNumbers(ray));
  }

  /* {hand, where}, or null for a miss. */
  grab(name, ray, reach) {
    const grip = this.#scene.in().json('wasm_motion_grab', this.at, name, rayNumbers(ray), reach);
    if (grip) this.#hands.add(grip.hand);
    return grip;
  }

  move(hand, by) {
    this.#scene.in().check('cuvette_motion_move', this.at, hand, by);
  }

  release(hand) {
    this.#scene.in().check('cuvette_motion_release', this.at, hand);
    this.#hands.delete(hand);
  }
}
