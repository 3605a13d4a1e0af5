/* Arguments and results in the memory of a module.
 *
 * exports: Memory
 *   memory.text(method, ...)      the text that a function of the module returns, which is freed; throws CuvetteError
 *   memory.json(method, ...)      like text, but parses JSON
 *   memory.check(method, ...)     calls a function of cuvette.h whose last parameter is `why`; throws CuvetteError
 *   memory.handle(method, ...)    like check, for a function whose parameter before `why` returns a new handle
 * Arguments: a string is passed as text, an array or a Float64Array as numbers of type double, a Uint8Array as bytes.
 * They are copied, and freed after the call. */

import { CuvetteError, FAILURE } from './errors.js';

const encoder = new TextEncoder();

export class Memory {
  constructor(module) {
    this.module = module;
    this.place = module._malloc(16); /* where functions return handles */
    this.error = module._wasm_error();
  }

  #put(bytes) {
    const address = this.module._malloc(bytes.length + 1);
    if (!address) throw new CuvetteError(FAILURE, { what: 'out of memory', remedy: 'use a smaller scene or image' });
    this.module.HEAPU8.set(bytes, address);
    this.module.HEAPU8[address + bytes.length] = 0;
    return address;
  }

  #argument(value, allocated) {
    if (typeof value === 'number' || typeof value === 'bigint') return value;
    if (typeof value === 'boolean') return Number(value);
    const bytes =
      typeof value === 'string'
        ? encoder.encode(value)
        : value instanceof Uint8Array
          ? value
          : new Uint8Array(Float64Array.from(value).buffer);
    allocated.push(this.#put(bytes));
    return allocated.at(-1);
  }

  call(method, ...values) {
    const allocated = [];
    try {
      return this.module[`_${method}`](...values.map((value) => this.#argument(value, allocated)));
    } finally {
      for (const address of allocated) this.module._free(address);
    }
  }

  /* status: the one that the call returned, if any. */
  lastError(status) {
    const address = this.module._wasm_error_json();
    if (!address) return new CuvetteError(FAILURE, { what: 'out of memory' });
    const report = JSON.parse(this.module.UTF8ToString(address));
    this.module._free(address);
    return new CuvetteError(status ?? report.status, report);
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

  /* Calls use(address) with the address of `size` bytes. */
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
