/* The API with its calls in a worker, as promises: the page stays free while a scene loads and a slime settles.
 *
 * exports: connect(worker, options) -> Promise of a Cuvette
 *   worker: new Worker('api/worker.js', {type: 'module'}), or one of node:worker_threads; nothing else may use it
 *   options: as for load; module must be an address
 * Every method except destroy() returns a promise of its result; version and isa are values. render and advance accept
 * progress, tile and signal. */

import { CALLS } from './calls.js';
import { CuvetteError, cancelled } from './errors.js';

class Connection {
  #waiting = new Map();
  #last = 0;

  constructor(worker) {
    this.worker = worker;
    this.collected = new FinalizationRegistry((number) => this.release(number));
    const receive = (message) => this.#receive(message);
    if (worker.on) worker.on('message', receive);
    else worker.addEventListener('message', ({ data }) => receive(data));
    const fail = (error) =>
      this.#fail(error.message ?? 'the worker cannot be started', 'check the address of the worker');
    if (worker.on) worker.on('error', fail);
    else worker.addEventListener('error', fail);
  }

  end() {
    this.#fail('the worker was ended', 'connect again');
    this.worker.terminate();
  }

  #fail(what, remedy) {
    for (const { reject } of this.#waiting.values()) reject(new CuvetteError(1, { what, remedy }));
    this.#waiting.clear();
  }

  #receive({ id, value, created, error, aborted, callback, values }) {
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
    else call.resolve(created ? this.make(created) : value);
  }

  /* Makes the page's object for an object of the worker. */
  make({ kind, number }) {
    const remote = new KINDS[kind](this, number);
    this.collected.register(remote, number, remote);
    return remote;
  }

  release(number) {
    this.worker.postMessage({ destroy: number });
  }

  /* The functions and the signal of an options object stay in the page. */
  #split(value, call) {
    if (value instanceof Remote) return { remote: value.number };
    if (!value || Object.getPrototypeOf(value) !== Object.prototype) return value;
    const plain = {};
    for (const [key, option] of Object.entries(value)) {
      if (typeof option === 'function') call.callbacks[key] = option;
      else if (key === 'signal') call.signal = option;
      else plain[key] = option;
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
  constructor(connection, number) {
    this.connection = connection;
    this.number = number;
  }

  destroy() {
    this.connection.collected.unregister(this);
    this.connection.release(this.number);
  }
}

const KINDS = Object.fromEntries(
  Object.entries(CALLS).map(([kind, methods]) => {
    const Kind = class extends Remote {};
    for (const method of methods)
      Kind.prototype[method] = function (...values) {
        return this.connection.call(this.number, method, values);
      };
    return [kind, Kind];
  }),
);

/* Addresses are relative to the page, not to the worker; a message cannot contain a URL object. */
function placeFor(options) {
  const absolute = (value) => {
    if (!(value instanceof URL || typeof value === 'string')) return value;
    return globalThis.location ? new URL(value, location.href).href : String(value);
  };
  return Object.fromEntries(Object.entries(options).map(([key, value]) => [key, absolute(value)]));
}

export async function connect(worker, options) {
  const connection = new Connection(worker);
  await connection.call(0, 'load', [placeFor(options)]);
  const cuvette = new KINDS.Cuvette(connection, 0);
  const facts = await cuvette.facts();
  return Object.assign(cuvette, facts, {
    Scene: { read: (...values) => cuvette.readScene(...values), create: () => cuvette.createScene() },
    memoryBytes: async () => (await cuvette.facts()).memoryBytes,
    destroy: () => connection.end(),
  });
}
