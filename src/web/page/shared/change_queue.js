/* The queue of changes: one request at a time, in order; only the newest request of a gesture and path waits. The
 * changes of a gesture wait for the images: the next one is sent when an image of the last one exists, so that a drag
 * at 60 events per second sends no more requests than there are images.
 *
 * exports: createQueue(post, imageOf) -> change(path, payload, {gesture, merge}) -> promise of the reply
 *   change.idle(): whether nothing is being sent or waits
 *   imageOf(generation, signal): a promise that resolves when an image of that generation or a newer one exists, or
 *   when the signal is aborted */

const PAUSE_MAX_MS = 100; /* the longest pause: images may be slower, or not come at all */

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export function createQueue(post, imageOf) {
  const waiting = [];
  let busy = false;

  async function send(entry) {
    try {
      const reply = await post(entry.path, entry.body());
      entry.resolve(reply);
      return reply.generation;
    } catch (error) {
      entry.reject(error);
      return undefined;
    }
  }

  async function work() {
    if (busy) return;
    busy = true;
    while (waiting.length) {
      const entry = waiting.shift();
      const generation = await send(entry);
      if (entry.gesture && generation && !(waiting.length && waiting[0].gesture !== entry.gesture))
        await waitForImage(generation, entry.gesture);
    }
    busy = false;
  }

  async function waitForImage(generation, gesture) {
    const enough = new AbortController();
    await Promise.race([imageOf(generation, enough.signal), pause(PAUSE_MAX_MS), hurry(gesture)]);
    enough.abort();
  }

  let hurried = null;

  /* Resolves when something other than the next change of the gesture waits. */
  function hurry(gesture) {
    return new Promise((resolve) => {
      hurried = { gesture, resolve };
    });
  }

  const change = (path, payload, { gesture, merge } = {}) => {
    const last = waiting[waiting.length - 1];
    if (last && gesture && last.gesture === gesture && last.path === path) {
      last.payload = merge ? merge(last.payload, payload) : payload;
      return last.promise;
    }
    const entry = { path, payload, gesture };
    entry.body = () => (gesture ? { ...entry.payload, gesture } : entry.payload);
    entry.promise = new Promise((resolve, reject) => Object.assign(entry, { resolve, reject }));
    waiting.push(entry);
    if (hurried && hurried.gesture !== gesture) hurried.resolve();
    work();
    return entry.promise;
  };
  change.idle = () => !busy;
  return change;
}
