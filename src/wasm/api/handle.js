/* Owners of a handle of the module: destroy() releases it, and so does the garbage collector at some later time.
 *
 * exports: Handle
 *   handle.at, its address; throws after destroy() */

import { badInput } from './errors.js';

const collected = new FinalizationRegistry((release) => release());

export class Handle {
  #address;
  #release;

  /* release() must not refer to the owner, which would then never be collected. */
  constructor(address, release) {
    this.#address = address;
    this.#release = release;
    collected.register(this, release, this);
  }

  get at() {
    if (!this.#address)
      throw badInput(`the ${this.constructor.kind.toLowerCase()} was destroyed`, 'create another one');
    return this.#address;
  }

  destroy() {
    if (!this.#address) return;
    this.#address = 0;
    collected.unregister(this);
    this.#release();
  }
}
