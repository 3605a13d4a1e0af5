/* The worker of connect(): holds the objects and answers calls. It is a module worker of a browser or of node.
 *
 * page -> worker  {id, number, method, values, callbacks}   number: of the object; values: {remote: number} for objects
 *                 {abort: id}, {destroy: number}
 * worker -> page  {id, value}, {id, created: {kind, number}}, {id, error}, {id, aborted: true}
 *                 {id, callback, values} */

import { CALLS } from './calls.js';
import { load } from './cuvette.js';

const port = globalThis.postMessage ? globalThis : (await import('node:worker_threads')).parentPort;
const objects = new Map();
const stops = new Map(); /* the AbortControllers of running calls */
let last = 0;

const KINDS = ['Scene', 'Query', 'Motion', 'Engine'];

/* Object 0: the loaded API. */
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

/* The buffers of a result, which are moved to the page, not copied. */
const buffersOf = (value) =>
  Object.values(value ?? {})
    .filter((one) => ArrayBuffer.isView(one))
    .map((one) => one.buffer);

function optionsOf(value, { id, callbacks }) {
  const options = { ...value };
  for (const callback of callbacks)
    options[callback] = (...values) => port.postMessage({ id, callback, values }, values.flatMap(buffersOf));
  options.signal = stops.get(id).signal;
  return options;
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
      port.postMessage({ id, created: { kind, number: last } });
    } else {
      port.postMessage({ id, value }, buffersOf(value));
    }
  } catch (error) {
    const report = error.toJSON?.() ?? { status: 1, what: String(error.message ?? error) };
    port.postMessage(error.name === 'AbortError' ? { id, aborted: true } : { id, error: report });
  } finally {
    stops.delete(id);
  }
}

function receive(message) {
  if (message.abort !== undefined) {
    stops.get(message.abort)?.abort();
  } else if (message.destroy !== undefined) {
    objects.get(message.destroy)?.destroy();
    objects.delete(message.destroy);
  } else {
    answer(message);
  }
}
port.addEventListener('message', ({ data }) => receive(data));
port.start?.();
