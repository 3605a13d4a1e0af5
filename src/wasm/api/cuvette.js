/* Cuvette in JavaScript: scenes, renders, ray trees and slimes of cuvette.h, in a browser or in node. The README in the
 * folder above describes it.
 *
 * exports: load({folder} or {module, wasm}) -> Promise of a Cuvette; connect(worker, options as for load) -> Promise of
 * a Cuvette whose calls run in a worker; hasVectors(); CuvetteError */

import { Engine } from './engine.js';
import { Memory } from './memory.js';
import { instantiate } from './module.js';
import { Scene } from './scene.js';

export { CuvetteError } from './errors.js';
export { connect } from './connect.js';
export { hasVectors } from './module.js';

class Cuvette {
  #memory;

  constructor(module) {
    this.#memory = new Memory(module);
    const memory = this.#memory;
    this.Scene = { read: (text, options) => Scene.read(memory, text, options), create: () => Scene.create(memory) };
  }

  get version() {
    return this.#memory.module.UTF8ToString(this.#memory.module._cuvette_version());
  }

  /* The instruction set: simd128 or plain. */
  get isa() {
    return this.#memory.module.UTF8ToString(this.#memory.module._wasm_isa());
  }

  /* Bytes of memory that the module has; the memory never shrinks. */
  get memoryBytes() {
    return this.#memory.module.HEAPU8.length;
  }

  engine() {
    return new Engine();
  }

  /* The four words of Philox4x32-10 for a key and a counter, of 2 and 4 words. */
  random(key, counter) {
    return this.#memory.withRoom(16, (room) => {
      this.#memory.call('wasm_random', ...key, ...counter, room);
      return [...new Uint32Array(this.#memory.module.HEAPU8.buffer.slice(room, room + 16))];
    });
  }
}

/* folder: the address of the folder that `make wasm` makes, from which simd128/ or plain/ is chosen; or module: the
 * address of cuvette.js or its function, and wasm: an address, bytes or a WebAssembly.Module. */
export async function load(options) {
  return new Cuvette(await instantiate(options));
}
