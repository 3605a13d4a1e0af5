/* The engine of a page without a server: the laboratory compiled to WebAssembly, in a worker of this page. Every tab
 * has a laboratory of its own. engine_boot.js starts the worker; the messages are described in src/web/README.md.
 * exports: createBrowserEngine() -> engine, see engine.js */

import { startWorker } from './engine_boot.js';

const STOPPED = 'the laboratory in this page stopped';
const RELOAD = 'reload the page; it offers unsaved changes again';

export function createBrowserEngine() {
  const requests = new Map(); /* id -> {resolve, reject} */
  const listeners = new Set();
  let last = 0;
  let ready = false;
  let failure = null;
  let remedy = RELOAD;
  const worker = (globalThis.cuvetteEngine?.started ?? startWorker()).then(connect);
  worker.catch(fail);

  return {
    kind: 'browser',
    reconnects: false,
    fetch: send,
    events(names, listener) {
      const mine = { names, ...listener };
      listeners.add(mine);
      queueMicrotask(() => {
        if (!listeners.has(mine)) return;
        if (failure) mine.error();
        else if (ready) mine.open();
      });
      return () => listeners.delete(mine);
    },
    async address(path) {
      const response = await send(path);
      if (!response.ok) throw new Error(`${path}: ${response.status}`);
      return URL.createObjectURL(await response.blob());
    },
    release: (address) => URL.revokeObjectURL(address),
    lost: () => ({ error: failure ? `${STOPPED}: ${failure}` : STOPPED, remedy }),
    idle: () => requests.size === 0,
  };

  function connect(made) {
    made.onmessage = ({ data }) => receive(data);
    made.onerror = (event) => {
      event.preventDefault();
      fail(event);
    };
    made.onmessageerror = () => fail(new Error('a message cannot be read'));
    made.early.forEach(receive);
    return made;
  }

  function receive(message) {
    if (message.event) {
      for (const { names, event } of listeners)
        if (names.includes(message.event)) event(message.event, JSON.parse(message.value));
    } else if (message.id !== undefined) answer(message);
    else if (message.ready) {
      ready = true;
      for (const { open } of [...listeners]) open();
    } else if (message.failed) fail(new Error(message.failed));
  }

  function answer({ id, status, headers, bytes }) {
    const waiting = requests.get(id);
    requests.delete(id);
    waiting?.resolve(new Response(status === 204 ? null : bytes, { status, headers }));
  }

  /* A worker that failed answers nothing more: the memory of the module may be broken. */
  function fail(error) {
    if (failure) return;
    failure = error.message || 'the browser does not say why';
    remedy = error.remedy || RELOAD;
    worker.then((made) => made.terminate()).catch(() => undefined);
    for (const { reject } of requests.values()) reject(new TypeError(failure));
    requests.clear();
    for (const { error: tell } of [...listeners]) tell();
  }

  function send(path, { method = 'GET', body = null, signal } = {}) {
    return new Promise((resolve, reject) => {
      if (failure) {
        reject(new TypeError(failure));
        return;
      }
      const id = ++last;
      requests.set(id, { resolve, reject });
      signal?.addEventListener('abort', () => {
        if (requests.delete(id)) reject(signal.reason);
      });
      worker.then((made) => made.postMessage({ id, method, path, body })).catch(() => undefined); /* told by fail */
    });
  }
}
