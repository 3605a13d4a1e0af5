/* One event stream for all tabs of the laboratory: a browser opens at most six connections to a server, and each stream
 * holds one. The tab that has the lock reads the stream and passes its events on to the others; when it is closed,
 * another gets the lock. Without locks or channels every tab has a stream of its own.
 *
 * exports: openEvents(names, {open(), error(), event(name, value)}) -> close()
 *   open: the stream works; events may have been missed before
 *   error: it does not; the caller closes and tries again */

const SHARED = 'cuvette-events'; /* the name of lock and channel */

function readStream(names, listener) {
  const source = new EventSource('/api/events');
  source.onopen = () => listener.open();
  source.onerror = () => listener.error();
  for (const name of names) source.addEventListener(name, (message) => listener.event(name, JSON.parse(message.data)));
  return source;
}

export function openEvents(names, listener) {
  if (!navigator.locks || !globalThis.BroadcastChannel) {
    const source = readStream(names, listener);
    return () => source.close();
  }
  const me = crypto.randomUUID();
  const channel = new BroadcastChannel(SHARED);
  const ended = new AbortController();
  let source = null;
  let release = null;
  const tell = (message) => channel.postMessage({ from: me, ...message });

  channel.onmessage = ({ data }) => {
    if (data.what === 'hello' && source?.readyState === EventSource.OPEN) tell({ what: 'open', to: data.from });
    else if (data.to && data.to !== me) return;
    else if (data.what === 'open') listener.open();
    else if (data.what === 'error') listener.error();
    else if (data.what === 'event') listener.event(data.name, data.value);
  };
  navigator.locks.request(SHARED, { signal: ended.signal }, lead).catch(() => undefined); /* closed while it waited */
  tell({ what: 'hello' });
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
        tell({ what: 'open' });
        listener.open();
      },
      error() {
        tell({ what: 'error' });
        listener.error();
      },
      event(name, value) {
        tell({ what: 'event', name, value });
        listener.event(name, value);
      },
    });
    return new Promise((resolve) => {
      release = resolve;
    });
  }
}
