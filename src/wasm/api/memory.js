/* Arguments and results in the memory of a module.
 *
 * exports: Memory
 *   memory.text(method, ...)      the text that a function of the module returns, which is freed; throws CuvetteError
 *   memory.json(method, ...)      the same as a value
 *   memory.check(method, ...)     a function of cuvette.h whose last parameter is `why`: throws CuvetteError
 *   memory.handle(method, ...)    the same, with the place of a new handle before `why`; returns the handle
 * Arguments: a string is passed as text, an array or a Float64Array as numbers of type double, a Uint8Array as bytes.
 * They are copied, and freed after the call. */

import { CuvetteError, FAILURE } from './errors.js';

const encoder = new TextEncoder();

export class Memory {
  constructor(module) {
    this.module = module;
    this.place = module._malloc(16); /* of results */
    this.error = module._wasm_error();
  }

  #put(bytes) {
    const address = this.module._malloc(bytes.length + 1);
    if (!address) throw new CuvetteError(FAILURE, { what: 'out of memory', remedy: 'use a smaller scene or image' });
    this.module.HEAPU8.set(bytes, address);
    this.module.HEAPU8[address + bytes.length] = 0;
    return address;
  }

  #argument(value, kept) {
    if (typeof value === 'number' || typeof value === 'bigint') return value;
    if (typeof value === 'boolean') return Number(value);
    const bytes =
      typeof value === 'string'
        ? encoder.encode(value)
        : value instanceof Uint8Array
          ? value
          : new Uint8Array(Float64Array.from(value).buffer);
    kept.push(this.#put(bytes));
    return kept.at(-1);
  }

  call(method, ...values) {
    const kept = [];
    try {
      return this.module[`_${method}`](...values.map((value) => this.#argument(value, kept)));
    } finally {
      for (const address of kept) this.module._free(address);
    }
  }

  /* status: of the call, if it returned one. */
  lastError(status) {
    const address = this.module._wasm_error_json();
    if (!address) return new CuvetteError(FAILURE, { what: 'out of memory' });
    const told = JSON.parse(this.module.UTF8ToString(address));
    this.module._free(address);
    return new CuvetteError(status ?? told.status, told);
  }

  text(method, ...values) {
    const address = this.call(method, ...values);
    if (!address) throw this.lastError();
    try {
      return this.module.UTF8ToString(address);
    } finally {
      this.module._free(address);
    }
  }

  json(method, ...values) {
    return JSON.parse(this.text(method, ...values));
  }

  check(method, ...values) {
    const status = this.call(method, ...values, this.error);
    if (status !== 0) throw this.lastError(status);
  }

  handle(method, ...values) {
    this.check(method, ...values, this.place);
    return new DataView(this.module.HEAPU8.buffer).getUint32(this.place, true);
  }

  /* Calls use(address) with room for that many bytes. */
  withRoom(size, use) {
    const address = this.module._malloc(size);
    if (!address) throw new CuvetteError(FAILURE, { what: 'out of memory', remedy: 'use a smaller scene or image' });
    try {
      return use(address);
    } finally {
      this.module._free(address);
    }
  }
}
