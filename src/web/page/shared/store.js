/* The page's copy of the laboratory's state, and the queue of changes: the object lab.
 *
 * The API calls every rendered pass an image (the event `image`, and `image` in the state). In the page a pass is what
 * is available, and the image is the pass that is displayed.
 *
 * exports: createLab() -> lab
 *   lab.engine                          see engine.js
 *   lab.get, lab.post, lab.del, lab.blob   see api.js; for requests that do not change the scene or need no order
 *   lab.state, lab.scene, lab.image, lab.slime, lab.study    the latest values; null before the first
 *   lab.newestGeneration                the newest known generation; older images are shown until an image of
 *                                       it exists
 *   lab.dragging()                      whether changes follow each other within DRAG_MS
 *   lab.newestPass                      the newest known pass, displayed or not
 *   lab.connected                       'opening', 'open', 'lost' or 'refused'
 *   lab.on(name, f) -> end()            names: state, scene, image (a pass is displayed), pass (a pass is available),
 *                                       slime, study, connection, restarted (a new server: all earlier data is
 *                                       void), opened ({file, link, lesson, new}: another scene), view (the image's
 *                                       placement changed), tool, panel (one was selected)
 *   lab.emit(name, value)
 *   lab.param(path)                     the row of that parameter; undefined if there is none, or if the scene has so
 *                                       many objects that only the rows of wanted ones are here (not scene.whole)
 *   lab.want(key, names)                those rows, of objects or paths, from now on; replaces what the key wanted;
 *                                       a promise that they are here
 *   lab.object(name)                    the object of that name; undefined if there is none
 *   lab.set(values, gesture)            {path: value}; promise of the reply. Sent in order; only the newest of a
 *                                       gesture waits
 *   lab.change(path, body, {gesture, merge})   any other POST that changes the scene, in the same order as set;
 *                                       merge(waiting, body) -> body merges two of one gesture and path (default: the
 *                                       newer replaces the older)
 *   lab.change.takeBack(gesture)        see change_queue.js
 *   lab.refresh()                       fetches state and scene again
 *   lab.start()                         opens the event stream
 *   lab.say(text, remedy), lab.fail(error), lab.notes      set by main.js */

import { say, translated } from './language.js';
import { createApi } from './api.js';
import { createQueue } from './change_queue.js';
import { engine } from './engine.js';

const RETRY_MS = 1000;
const STRANGER_RETRY_MS = 5000;
const PULSE_MS = 10000;
const SCENE_MS = 150; /* minimum time between two fetches of the scene */
const DRAG_MS = 250; /* changes that follow each other within this time are a drag */
const REST_MS = 150; /* a drag without a change for this time rests */
const EVENTS = ['state', 'image', 'slime', 'study'];

function createEmitter() {
  const listeners = new Map();
  return {
    on(name, listener) {
      if (!listeners.has(name)) listeners.set(name, new Set());
      listeners.get(name).add(listener);
      return () => listeners.get(name).delete(listener);
    },
    emit(name, value) {
      for (const listener of [...(listeners.get(name) || [])]) {
        try {
          listener(value);
        } catch (error) {
          console.error(error);
        }
      }
    },
  };
}

export function createLab() {
  const { on, emit } = createEmitter();
  let rows = new Map();
  let objects = new Map();
  let stream = null;
  let retry = 0;
  let fetching = null; /* a promise */
  const wants = new Map();
  let again = false;
  let stale = false;
  let changedAt = -Infinity;
  let dragged = false;

  const api = createApi(engine, {
    generation: (value) => noteGeneration(value),
    reached: () => undefined,
    lost: () => lose('lost'),
    refused: () => lose('refused'),
  });

  const lab = {
    state: null,
    scene: null,
    image: null,
    newestPass: null,
    slime: null,
    study: null,
    newestGeneration: 0,
    connected: 'opening',
    engine,
    ...api,
    on,
    emit,
    dragging: () => dragged && performance.now() - changedAt < REST_MS,
    param: (path) => rows.get(path),
    want,
    object: (name) => objects.get(name),
    say: (text) => console.info(text),
    fail: (error) => console.error(error),
    start: connect,
    refresh,
  };
  if (engine.reconnects) setInterval(pulse, PULSE_MS);
  const change = createQueue(api.post, imageOf);
  lab.change = (path, body, options) => {
    const reply = change(path, body, options);
    const lesson = /^\/api\/lessons\/(.*)\/open$/.exec(path)?.[1];
    if (path === '/api/open' || lesson)
      reply.then(
        () => emit('opened', { ...body, lesson }),
        () => undefined,
      );
    return reply;
  };
  Object.assign(lab.change, { idle: change.idle, takeBack: change.takeBack });
  lab.set = (values, gesture) =>
    lab
      .change(
        '/api/set',
        { set: values },
        {
          gesture,
          merge: (waiting, newer) => ({ set: { ...waiting.set, ...newer.set } }),
        },
      )
      .then((reply) => {
        const [first] = reply.notes || []; /* parameters that have no effect */
        if (first) lab.say(say('Note: {place}: {text}', { ...first, text: translated(first.text) }), first.remedy);
        return reply;
      });
  return lab;

  function noteGeneration(generation) {
    if (generation <= lab.newestGeneration) return;
    const now = performance.now();
    dragged = now - changedAt < DRAG_MS;
    changedAt = now;
    lab.newestGeneration = generation;
  }

  function connection(value) {
    if (lab.connected === value) return;
    lab.connected = value;
    emit('connection', value);
  }

  function lose(how) {
    stream?.close();
    stream = null;
    connection(how);
    clearTimeout(retry);
    if (engine.reconnects) retry = setTimeout(connect, how === 'refused' ? STRANGER_RETRY_MS : RETRY_MS);
  }

  /* Events that come while recover waits for the state are queued: they may be newer than the state. */
  function connect() {
    clearTimeout(retry);
    stream?.close();
    const mine = { queued: null };
    stream = mine;
    mine.close = engine.events(EVENTS, {
      open: () => recover(mine),
      error() {
        if (stream !== mine) return;
        if (lab.connected === 'refused') lose('refused');
        else ask();
      },
      event(name, value) {
        if (stream !== mine) return;
        if (mine.queued) mine.queued.push([name, value]);
        else receive(name, value);
      },
    });
  }

  /* A broken connection may look open at this end. */
  function pulse() {
    if (lab.connected === 'open')
      api.get('/api/state', PULSE_MS).catch((error) => {
        if (error.status === 0) lose('lost');
      });
  }

  /* The stream does not report the cause of its failure, but a request does. */
  async function ask() {
    lose('lost');
    await lab.get('/api/state').catch(() => undefined);
  }

  /* A restarted server counts its generations from the beginning. */
  async function recover(mine) {
    if (stream !== mine) return;
    mine.queued ??= [];
    try {
      const state = await api.get('/api/state');
      if (stream !== mine) return;
      if (!lab.state || state.generation < lab.state.generation || lab.connected !== 'open') {
        Object.assign(lab, { newestGeneration: 0, newestPass: null });
        stale = true;
        emit('restarted', null);
      }
      connection('open');
      receive('state', state);
    } catch (error) {
      if (stream === mine && error.status !== 401 && error.status !== 0) lab.fail(error);
    }
    const queued = mine.queued ?? [];
    mine.queued = null;
    if (stream === mine) for (const [name, value] of queued) receive(name, value);
  }

  function receive(name, value) {
    if (name === 'state') {
      noteGeneration(value.generation);
      lab.state = value;
      lab.slime = value.slime;
      lab.study = value.study;
      if (value.image && !(lab.newestPass?.serial > value.image.serial)) lab.newestPass = value.image;
      emit('state', value);
      if (stale || !lab.scene || lab.scene.generation < value.generation) fetchScene();
    } else if (name === 'image') {
      lab.newestPass = value;
      emit('pass', value);
    } else {
      lab[name] = value;
      if (lab.state) lab.state[name] = value;
      emit(name, value);
    }
  }

  function refresh() {
    return api.get('/api/state').then((state) => receive('state', state));
  }

  /* Resolves when an image of the generation or a newer one exists, or when the signal is aborted. */
  function imageOf(generation, signal) {
    return new Promise((resolve) => {
      const ends = ['pass', 'state', 'restarted'].map((name) =>
        on(name, () => {
          if (name === 'restarted' || exists()) finish();
        }),
      );
      const exists = () => (lab.newestPass?.generation ?? 0) >= generation;
      const finish = () => {
        for (const end of ends) end();
        resolve();
      };
      signal.addEventListener('abort', finish, { once: true });
      if (exists()) finish();
    });
  }

  async function want(key, names) {
    wants.set(key, names);
    if (lacksWanted()) await fetchScene();
    if (lacksWanted()) await fetchScene(); /* the first was on its way already */
  }

  function wanted() {
    return [...new Set([...wants.values()].flat())].filter(Boolean).join(',');
  }

  function lacksWanted() {
    return lab.scene?.whole === false && lab.scene.of !== wanted();
  }

  /* Calls during a fetch are merged into one more fetch. */
  function fetchScene() {
    if (fetching) again = true;
    else
      fetching = fetchNow().finally(() => {
        fetching = null;
      });
    return fetching;
  }

  async function fetchNow() {
    do {
      again = false;
      const complete = stale;
      stale = false;
      try {
        const known = complete ? null : lab.scene;
        takeScene(applyScene(known, await api.get(`/api/scene${question(known)}`), lab.scene));
        await new Promise((resolve) => setTimeout(resolve, SCENE_MS));
      } catch (error) {
        if (error.status) lab.fail(error);
        again = false;
        stale ||= complete;
      }
    } while (again && lab.state && lab.scene && (lab.scene.generation < lab.state.generation || lacksWanted()));
  }

  function question(known) {
    const words = lab.scene?.whole === false ? wanted() : '';
    const parts = [
      known && `since=${known.generation}`,
      words && `of=${encodeURIComponent(words)}`,
      known && lacksWanted() && 'rows=all',
    ].filter(Boolean);
    return parts.length ? `?${parts.join('&')}` : '';
  }

  function takeScene(scene) {
    rows = new Map(scene.params.map((row) => [row.path, row]));
    if (scene.objects !== lab.scene?.objects) objects = new Map(scene.objects.map((object) => [object.name, object]));
    lab.scene = scene;
    emit('scene', scene);
    if (lacksWanted()) again = true;
  }
}

/* The scene of /api/scene?since=GENERATION: the differences from that generation are applied to the page's copy, which
 * is not altered. A complete reply is the scene itself. The list of objects stays the same array as long as the objects
 * do, so that lists of thousands need not compare them. */
function applyScene(known, reply, before) {
  if (reply.since === undefined) {
    const alike = before && JSON.stringify(before.objects) === JSON.stringify(reply.objects);
    return alike ? { ...reply, objects: before.objects } : reply;
  }
  const { since, order, params, ...parts } = reply;
  const rows = new Map(known.params.map((row) => [row.path, row]));
  for (const row of params) rows.set(row.path, row);
  const paths = order || known.params.map((row) => row.path);
  return { ...known, ...parts, params: paths.map((path) => rows.get(path)) };
}
