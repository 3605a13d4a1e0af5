/* The queue of changes: one request at a time, in order; only the newest request of a gesture and path waits. The
 * changes of a gesture wait for the images: the next one is sent when an image of the last one exists, so that a drag
 * at 60 events per second sends no more requests than there are images.
 *
 * exports: createQueue(post, imageOf) -> change(path, payload, {gesture, merge}) -> promise of the reply
 *   change.idle(): whether nothing is being sent or waits
 *   change.takeBack(gesture): drops the waiting changes of a gesture and undoes the others, if it was the last one
 *   imageOf(generation, signal): a promise that resolves when an image of that generation or a newer one exists, or
 *   when the signal is aborted */

const PAUSE_MAX_MS = 100; /* the longest pause: images may be slower, or not come at all */

const NOTHING = { generation: 0 }; /* the reply to a change that is not made */

/* Moves of the camera have a history of their own. */
const wayBack = (path) => (path === '/api/camera' ? ['/api/view', { do: 'back' }] : ['/api/undo', {}]);

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export function createQueue(post, imageOf) {
  const waiting = [];
  let busy = false;
  let applied = {}; /* {path, gesture} of the last change */

  async function send(entry) {
    try {
      const reply = await post(...(entry.takes ? wayBack(applied.path) : [entry.path, entry.body()]));
      applied = { path: entry.path, gesture: entry.gesture };
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
      if (entry.takes && entry.takes !== applied.gesture) {
        entry.resolve(NOTHING);
        continue;
      }
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

  function push(entry) {
    entry.promise = new Promise((resolve, reject) => Object.assign(entry, { resolve, reject }));
    waiting.push(entry);
    if (hurried && hurried.gesture !== entry.gesture) hurried.resolve();
    work();
    return entry.promise;
  }

  const change = (path, payload, { gesture, merge } = {}) => {
    const last = waiting[waiting.length - 1];
    if (last && gesture && last.gesture === gesture && last.path === path) {
      last.payload = merge ? merge(last.payload, payload) : payload;
      return last.promise;
    }
    const entry = { path, payload, gesture };
    entry.body = () => (gesture ? { ...entry.payload, gesture } : entry.payload);
    return push(entry);
  };
  change.takeBack = (gesture) => {
    for (const entry of waiting.filter((each) => each.gesture === gesture)) {
      waiting.splice(waiting.indexOf(entry), 1);
      entry.resolve(NOTHING);
    }
    return push({ takes: gesture });
  };
  change.idle = () => !busy;
  return change;
}
