/* The worker of connect(): holds the objects and answers calls. As a module worker of a browser or of node.
 *
 * page -> worker  {id, number, method, values, callbacks}   number: of the object; values: {remote: number} for objects
 *                 {abort: id}, {destroy: number}
 * worker -> page  {id, value}, {id, made: {kind, number}}, {id, error}, {id, aborted: true}
 *                 {id, callback, values} */

import { CALLS } from './calls.js';
import { load } from './cuvette.js';

const port = globalThis.postMessage ? globalThis : (await import('node:worker_threads')).parentPort;
const objects = new Map();
const stops = new Map(); /* the AbortControllers of calls that run */
let last = 0;

const KINDS = ['Scene', 'Query', 'Motion', 'Engine'];

/* The loaded API as an object of calls. */
class Root {
  async load(options) {
    const cuvette = await load(options);
    Object.assign(this, {
      random: (...values) => cuvette.random(...values),
      engine: () => cuvette.engine(),
      readScene: (...values) => cuvette.Scene.read(...values),
      createScene: () => cuvette.Scene.create(),
      facts: () => ({ version: cuvette.version, isa: cuvette.isa, memoryBytes: cuvette.memoryBytes }),
    });
  }
}
objects.set(0, new Root());

const kindOf = (value) => KINDS.find((kind) => value?.constructor?.kind === kind);

/* Copies nothing: buffers that the result alone has move to the page. */
const buffersOf = (value) =>
  Object.values(value ?? {})
    .filter((one) => ArrayBuffer.isView(one))
    .map((one) => one.buffer);

function optionsOf(value, { id, callbacks }) {
  const own = { ...value };
  for (const callback of callbacks)
    own[callback] = (...values) => port.postMessage({ id, callback, values }, values.flatMap(buffersOf));
  own.signal = stops.get(id).signal;
  return own;
}

const takesOptions = (method) => method === 'render' || method === 'advance';

function valuesOf(message) {
  const values = message.values.map((value) => (value?.remote === undefined ? value : objects.get(value.remote)));
  if (takesOptions(message.method)) values[1] = optionsOf(values[1], message);
  return values;
}

async function answer(message) {
  const { id, number, method } = message;
  stops.set(id, new AbortController());
  try {
    const target = objects.get(number);
    const known = method === 'load' || CALLS[kindOf(target) ?? 'Cuvette'].includes(method);
    if (!target || !known) throw new Error(`there is no ${method} of object ${number}`);
    const value = await target[method](...valuesOf(message));
    const kind = kindOf(value);
    if (kind) {
      objects.set(++last, value);
      port.postMessage({ id, made: { kind, number: last } });
    } else {
      port.postMessage({ id, value }, buffersOf(value));
    }
  } catch (error) {
    const told = error.toJSON?.() ?? { status: 1, what: String(error.message ?? error) };
    port.postMessage(error.name === 'AbortError' ? { id, aborted: true } : { id, error: told });
  } finally {
    stops.delete(id);
  }
}

function hear(message) {
  if (message.abort !== undefined) {
    stops.get(message.abort)?.abort();
  } else if (message.destroy !== undefined) {
    objects.get(message.destroy)?.destroy();
    objects.delete(message.destroy);
  } else {
    answer(message);
  }
}
port.addEventListener('message', ({ data }) => hear(data));
port.start?.();
