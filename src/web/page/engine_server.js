/* The engine of a page that `cuvette lab` served: requests and events over HTTP.
 * exports: createServerEngine() -> engine, see engine.js */

import { openEvents } from './event_stream.js';

const LOST = {
  error: 'the server does not answer',
  remedy: 'check in its terminal that cuvette lab is still running',
};

export function createServerEngine() {
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
