/* The API with its calls in a worker, as promises: the page stays free while a scene loads and a slime settles.
 *
 * exports: connect(worker, options) -> Promise of a Cuvette
 *   worker: new Worker('api/worker.js', {type: 'module'}), or one of node:worker_threads, for this alone
 *   options: as for load; module must be an address
 * Every method returns a promise, of the same result; destroy() does not, and version, isa are values. A render and an
 * advance take progress, tile and signal. */

import { CALLS } from './calls.js';
import { CuvetteError, cancelled } from './errors.js';

class Line {
  #waiting = new Map();
  #last = 0;

  constructor(worker) {
    this.worker = worker;
    this.collected = new FinalizationRegistry((number) => this.release(number));
    const hear = (message) => this.#hear(message);
    if (worker.on) worker.on('message', hear);
    else worker.addEventListener('message', ({ data }) => hear(data));
    const fail = (error) => this.#fail(error.message ?? 'the worker cannot be started');
    if (worker.on) worker.on('error', fail);
    else worker.addEventListener('error', fail);
  }

  end() {
    this.#fail('the worker was ended');
    this.worker.terminate();
  }

  #fail(what) {
    for (const { reject } of this.#waiting.values())
      reject(new CuvetteError(1, { what, remedy: 'check the address of the worker' }));
    this.#waiting.clear();
  }

  #hear({ id, value, made, error, aborted, callback, values }) {
    const call = this.#waiting.get(id);
    if (!call) return;
    if (callback) {
      call.callbacks[callback](...values);
      return;
    }
    this.#waiting.delete(id);
    call.end();
    if (aborted) call.reject(cancelled(call.signal));
    else if (error) call.reject(new CuvetteError(error.status, error));
    else call.resolve(made ? this.make(made) : value);
  }

  /* The object of a worker's object. */
  make({ kind, number }) {
    const remote = new KINDS[kind](this, number);
    this.collected.register(remote, number, remote);
    return remote;
  }

  release(number) {
    this.worker.postMessage({ destroy: number });
  }

  /* An options object's functions stay here, and its signal. */
  #split(value, call) {
    if (value instanceof Remote) return { remote: value.number };
    if (!value || Object.getPrototypeOf(value) !== Object.prototype) return value;
    const plain = {};
    for (const [key, one] of Object.entries(value)) {
      if (typeof one === 'function') call.callbacks[key] = one;
      else if (key === 'signal') call.signal = one;
      else plain[key] = one;
    }
    return plain;
  }

  call(number, method, values) {
    const id = ++this.#last;
    return new Promise((resolve, reject) => {
      const call = { resolve, reject, callbacks: {}, signal: null, end() {} };
      const plain = values.map((value) => this.#split(value, call));
      if (call.signal?.aborted) throw cancelled(call.signal);
      if (call.signal) {
        const stop = () => this.worker.postMessage({ abort: id });
        call.signal.addEventListener('abort', stop);
        call.end = () => call.signal.removeEventListener('abort', stop);
      }
      this.#waiting.set(id, call);
      this.worker.postMessage({ id, number, method, values: plain, callbacks: Object.keys(call.callbacks) });
    });
  }
}

class Remote {
  constructor(line, number) {
    this.line = line;
    this.number = number;
  }

  destroy() {
    this.line.collected.unregister(this);
    this.line.release(this.number);
  }
}

const KINDS = Object.fromEntries(
  Object.entries(CALLS).map(([kind, methods]) => {
    const Kind = class extends Remote {};
    for (const method of methods)
      Kind.prototype[method] = function (...values) {
        return this.line.call(this.number, method, values);
      };
    return [kind, Kind];
  }),
);

/* Addresses are the page's, not the worker's; a message cannot hold a URL. */
function placeFor(options) {
  const whole = (one) => {
    if (!(one instanceof URL || typeof one === 'string')) return one;
    return globalThis.location ? new URL(one, location.href).href : String(one);
  };
  return Object.fromEntries(Object.entries(options).map(([key, one]) => [key, whole(one)]));
}

export async function connect(worker, options) {
  const line = new Line(worker);
  await line.call(0, 'load', [placeFor(options)]);
  const cuvette = new KINDS.Cuvette(line, 0);
  const facts = await cuvette.facts();
  return Object.assign(cuvette, facts, {
    Scene: { read: (...values) => cuvette.readScene(...values), create: () => cuvette.createScene() },
    memoryBytes: async () => (await cuvette.facts()).memoryBytes,
    destroy: () => line.end(),
  });
}
