/* Rendering in turns. See "rendering" in cuvette.h.
 *
 * exports: Engine
 *   engine.render(scene, {progress, tile, signal, preview}) -> Promise of
 *     {width, height, srgb, rgb, hash, counters, wall_s}
 *   progress(fraction)  0..1
 *   tile({x0, y0, x1, y1, coarse, width, height, srgb})   finished pixels; in a preview (coarse > 1) width x height
 *                    values, one per coarse x coarse pixels
 *   signal           an AbortSignal
 *   preview          2..64: first an image of 1/preview of the width and height, as a tile
 *   srgb: Uint8ClampedArray, RGBA for ImageData; rgb: Float32Array, linear, 3 per pixel; hash: 16 hex digits; wall_s:
 *   seconds spent in turns */

import { badInput, cancelled, BUSY, CuvetteError } from './errors.js';
import { Handle } from './handle.js';
import { breathe, BUDGET_MS } from './turns.js';

class Render extends Handle {
  static kind = 'Render';

  constructor(scene, coarse) {
    const memory = scene.in();
    const address = memory.call('wasm_render_create', scene.at, coarse);
    if (!address) throw memory.lastError();
    super(address, () => memory.call('wasm_render_destroy', address));
    this.scene = scene;
    this.memory = memory;
    this.coarse = coarse;
  }

  srgb(x0, y0, x1, y1) {
    const size = 4 * (x1 - x0) * (y1 - y0);
    return this.memory.withRoom(size, (room) => {
      this.memory.call('wasm_render_srgb', this.at, x0, y0, x1, y1, room);
      return new Uint8ClampedArray(this.memory.module.HEAPU8.buffer.slice(room, room + size));
    });
  }

  rgb(width, height) {
    const size = 12 * width * height;
    return this.memory.withRoom(size, (room) => {
      this.memory.call('wasm_render_rgb', this.at, room);
      return new Float32Array(this.memory.module.HEAPU8.buffer.slice(room, room + size));
    });
  }

  turn() {
    const status = this.scene.in().call('wasm_render_turn', this.at, BUDGET_MS / 1000);
    if (status) throw this.memory.lastError(status);
    return this.memory.call('wasm_render_fraction', this.at);
  }

  /* Passes the tiles since the last call to tile(). */
  show(tile) {
    for (const [x0, y0, x1, y1] of this.memory.json('wasm_render_tiles', this.at))
      tile({ x0, y0, x1, y1, coarse: 1, width: x1 - x0, height: y1 - y0, srgb: this.srgb(x0, y0, x1, y1) });
  }

  result() {
    return this.memory.json('wasm_render_result', this.at);
  }
}

export class Engine {
  static kind = 'Engine';
  #busy = false;
  #stop = null;

  async render(scene, { progress, signal, tile, preview = 0 } = {}) {
    if (this.#busy)
      throw new CuvetteError(BUSY, { what: 'the engine is rendering', remedy: 'wait for the render to end' });
    if (preview && !(preview >= 2 && preview <= 64))
      throw badInput(`the request's preview is ${preview}`, 'set it to 0, or from 2 to 64');
    this.#busy = true;
    this.#stop = new AbortController();
    try {
      const signals = [signal, this.#stop.signal].filter(Boolean);
      if (preview) await this.#preview(scene, preview, signals, tile);
      return await this.#full(scene, signals, progress, tile);
    } finally {
      this.#busy = false;
    }
  }

  cancel() {
    this.#stop?.abort();
  }

  destroy() {
    this.cancel();
  }

  async #run(render, signals, each) {
    for (let fraction = 0; ;) {
      for (const signal of signals) if (signal.aborted) throw cancelled(signal);
      each?.(fraction);
      if (fraction === 1) return;
      await breathe();
      for (const signal of signals) if (signal.aborted) throw cancelled(signal);
      fraction = render.turn();
    }
  }

  async #preview(scene, coarse, signals, tile) {
    const render = new Render(scene, coarse);
    try {
      await this.#run(render, signals);
      const { width, height } = render.result();
      const [x1, y1] = ['render.width', 'render.height'].map((path) => Number(scene.get(path)));
      tile?.({ x0: 0, y0: 0, x1, y1, coarse, width, height, srgb: render.srgb(0, 0, width, height) });
    } finally {
      render.destroy();
    }
  }

  async #full(scene, signals, progress, tile) {
    const render = new Render(scene, 1);
    try {
      await this.#run(render, signals, (fraction) => {
        if (tile) render.show(tile);
        progress?.(fraction);
      });
      const result = render.result();
      const { width, height } = result;
      return { ...result, srgb: render.srgb(0, 0, width, height), rgb: render.rgb(width, height) };
    } finally {
      render.destroy();
    }
  }
}
