/* Turns of long calls: the thread's other work runs between them.
 *
 * exports: BUDGET_MS, breathe() */

export const BUDGET_MS = 20;

/* Resolves when pending messages and events are handled, without the delay of a timer. */
export const breathe = globalThis.setImmediate
  ? () => new Promise((resolve) => setImmediate(resolve))
  : () =>
      new Promise((resolve) => {
        const { port1, port2 } = new MessageChannel();
        port1.onmessage = () => {
          port1.close();
          resolve();
        };
        port2.postMessage(null);
      });
