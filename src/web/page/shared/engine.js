/* The engine: the laboratory behind the page, which renders and answers the requests of the API (src/web/README.md).
 * It is the program that served the page, or a worker of this page. The page chooses by
 * <meta name="cuvette-engine" content="browser">; without it, the engine is the program.
 *
 * exports: engine
 *   engine.kind                 'server' or 'browser'
 *   engine.fetch(path, {method, headers, body, signal, ..}) -> promise of a Response; rejects if there is no answer
 *   engine.events(names, {open(), error(), event(name, value)}) -> close(); open: events may have been missed before
 *   engine.address(path) -> promise of an address for images and links; engine.release(address) when it is not needed
 *                               any more
 *   engine.reconnects           whether an engine that does not answer may come back
 *   engine.lost() -> {error, remedy}     why it does not answer
 *   engine.idle()               whether no request waits for its reply */

import { startWorker } from './engine_boot.js';

/* --- the program: requests and events over HTTP ---
 * One event stream for all tabs of the laboratory: a browser opens at most six connections to a server, and each stream
 * occupies one. The tab that has the lock reads the stream and passes its events on to the others; when that tab is
 * closed, another gets the lock. Without locks or channels, or where they are forbidden, as in a frame of another site,
 * every tab has its own stream. */

const SHARED = 'cuvette-events'; /* the name of lock and channel */

function readStream(names, listener) {
  const source = new EventSource('/api/events');
  source.onopen = () => listener.open();
  source.onerror = () => listener.error();
  for (const name of names) source.addEventListener(name, (message) => listener.event(name, JSON.parse(message.data)));
  return source;
}

function openEvents(names, listener) {
  if (!navigator.locks || !globalThis.BroadcastChannel) {
    const source = readStream(names, listener);
    return () => source.close();
  }
  const me = crypto.randomUUID();
  const channel = new BroadcastChannel(SHARED);
  const ended = new AbortController();
  let source = null;
  let release = null;
  const post = (message) => channel.postMessage({ from: me, ...message });

  channel.onmessage = ({ data }) => {
    if (data.what === 'hello' && source?.readyState === EventSource.OPEN) post({ what: 'open', to: data.from });
    else if (data.to && data.to !== me) return;
    else if (data.what === 'open') listener.open();
    else if (data.what === 'error') listener.error();
    else if (data.what === 'event') listener.event(data.name, data.value);
  };
  navigator.locks.request(SHARED, { signal: ended.signal }, lead).catch(lead);
  post({ what: 'hello' });
  return () => {
    ended.abort();
    source?.close();
    release?.();
    channel.close();
  };

  /* Reads the stream until this tab closes it. */
  function lead() {
    if (ended.signal.aborted) return undefined;
    source = readStream(names, {
      open() {
        post({ what: 'open' });
        listener.open();
      },
      error() {
        post({ what: 'error' });
        listener.error();
      },
      event(name, value) {
        post({ what: 'event', name, value });
        listener.event(name, value);
      },
    });
    return new Promise((resolve) => {
      release = resolve;
    });
  }
}

const LOST = {
  error: 'the server does not answer',
  remedy: 'check in its terminal that cuvette lab is still running',
};

function createServerEngine() {
  let waiting = 0;
  return {
    kind: 'server',
    reconnects: true,
    async fetch(path, options) {
      waiting++;
      try {
        return await fetch(path, { credentials: 'same-origin', cache: 'no-store', ...options });
      } finally {
        waiting--;
      }
    },
    events: openEvents,
    address: async (path) => path,
    release: () => undefined,
    lost: () => LOST,
    idle: () => waiting === 0,
  };
}

/* --- a worker of this page: the laboratory compiled to WebAssembly ---
 * Every tab has its own laboratory. engine_boot.js starts the worker; src/web/README.md describes the messages. */

const STOPPED = 'the laboratory in this page stopped';
const RELOAD = 'reload the page; it offers unsaved changes again';

function createBrowserEngine() {
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

  function connect(instance) {
    instance.onmessage = ({ data }) => receive(data);
    instance.onerror = (event) => {
      event.preventDefault();
      fail(event);
    };
    instance.onmessageerror = () => fail(new Error('a message cannot be read'));
    instance.early.forEach(receive);
    return instance;
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
    worker.then((instance) => instance.terminate()).catch(() => undefined);
    for (const { reject } of requests.values()) reject(new TypeError(failure));
    requests.clear();
    for (const { error: report } of [...listeners]) report();
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
      /* An error is reported by fail. */
      worker.then((instance) => instance.postMessage({ id, method, path, body })).catch(() => undefined);
    });
  }
}

const chosen = document.querySelector('meta[name="cuvette-engine"]')?.content;

export const engine = chosen === 'browser' ? createBrowserEngine() : createServerEngine();
