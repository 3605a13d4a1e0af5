/* What the page knows of the server, and the way changes go there: the object lab.
 *
 * exports: createLab() -> lab
 *   lab.get, lab.post, lab.del, lab.blob   see api.js; for what is no change of the scene, or needs no order
 *   lab.state, lab.scene, lab.picture, lab.slime, lab.study    what came last; null before
 *   lab.wanted                          the newest generation that is known of: older pictures are not shown
 *   lab.connected                       'opening', 'open', 'lost' or 'refused'
 *   lab.on(name, f) -> end()            names: state, scene, picture (a pass was drawn), news (a pass is there), slime,
 *                                       study, connection,
 *                                       afresh (another server: what was known is void), view (the picture's place
 *                                       changed), tool, panel (one was chosen)
 *   lab.emit(name, value)
 *   lab.param(path)                     the row of that parameter; undefined: the scene has none
 *   lab.object(name)                    the object of that name; undefined
 *   lab.set(values, gesture)            {path: value}; promise of the reply. In order; of one gesture only the newest
 *                                       waits
 *   lab.change(path, body, {gesture, merge})   any other POST that changes the scene, in the same order as set;
 *                                              merge(waiting, body) -> body joins
 *                                       two of one gesture and path (default: the newer takes the place of the older)
 *   lab.refresh()                       asks for state and scene anew
 *   lab.start()                         opens the stream of events
 *   lab.say(text, remedy), lab.fail(error), lab.notes      set by main.js */

import { createApi } from './api.js';

const RETRY_MS = 1000;
const STRANGER_RETRY_MS = 5000;
const PULSE_MS = 10000;
const SCENE_MS = 150; /* the scene is fetched no more often */
const EVENTS = ['state', 'picture', 'slime', 'study'];

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

/* One request at a time; those that wait keep their order, and of one gesture and path only one waits. */
function createQueue(post) {
  const waiting = [];
  let busy = false;

  async function work() {
    if (busy) return;
    busy = true;
    while (waiting.length) {
      const entry = waiting.shift();
      try {
        entry.resolve(await post(entry.path, entry.body()));
      } catch (error) {
        entry.reject(error);
      }
    }
    busy = false;
  }

  return (path, payload, { gesture, merge } = {}) => {
    const last = waiting[waiting.length - 1];
    if (last && gesture && last.gesture === gesture && last.path === path) {
      last.payload = merge ? merge(last.payload, payload) : payload;
      return last.promise;
    }
    const entry = { path, payload, gesture };
    entry.body = () => (gesture ? { ...entry.payload, gesture } : entry.payload);
    entry.promise = new Promise((resolve, reject) => Object.assign(entry, { resolve, reject }));
    waiting.push(entry);
    work();
    return entry.promise;
  };
}

export function createLab() {
  const { on, emit } = createEmitter();
  let rows = new Map();
  let objects = new Map();
  let stream = null;
  let retry = 0;
  let fetching = null;
  let again = false;
  let stale = false;

  const api = createApi({
    generation: (value) => want(value),
    reached: () => undefined,
    lost: () => lose('lost'),
    refused: () => lose('refused'),
  });

  const lab = {
    state: null,
    scene: null,
    picture: null,
    news: null,
    slime: null,
    study: null,
    wanted: 0,
    connected: 'opening',
    ...api,
    on,
    emit,
    param: (path) => rows.get(path),
    object: (name) => objects.get(name),
    say: (text) => console.info(text),
    fail: (error) => console.error(error),
    start: connect,
    refresh,
  };
  setInterval(pulse, PULSE_MS);
  lab.change = createQueue(api.post);
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
        const [first] = reply.notes || []; /* what was set and does nothing */
        if (first) lab.say(`Note: ${first.place}: ${first.text}`, first.remedy);
        return reply;
      });
  return lab;

  function want(generation) {
    if (generation > lab.wanted) lab.wanted = generation;
  }

  function connection(value) {
    if (lab.connected === value) return;
    lab.connected = value;
    emit('connection', value);
  }

  function lose(how) {
    if (stream) stream.close();
    stream = null;
    connection(how);
    clearTimeout(retry);
    retry = setTimeout(connect, how === 'refused' ? STRANGER_RETRY_MS : RETRY_MS);
  }

  function connect() {
    clearTimeout(retry);
    if (stream) stream.close();
    const mine = new EventSource('/api/events');
    stream = mine;
    mine.onopen = () => recover(mine);
    mine.onerror = () => {
      if (stream !== mine) return;
      if (lab.connected === 'refused') lose('refused');
      else ask();
    };
    for (const name of EVENTS) {
      mine.addEventListener(name, (event) => {
        if (stream === mine) receive(name, JSON.parse(event.data));
      });
    }
  }

  /* A connection that is cut on the way may stay open at this end. */
  function pulse() {
    if (lab.connected === 'open')
      api.get('/api/state', PULSE_MS).catch((error) => {
        if (error.status === 0) lose('lost');
      });
  }

  /* The stream does not say why it failed; a request does. */
  async function ask() {
    lose('lost');
    await lab.get('/api/state').catch(() => undefined);
  }

  /* A server that was started anew counts its generations from the start. */
  async function recover(mine) {
    try {
      const state = await api.get('/api/state');
      if (stream !== mine) return;
      if (!lab.state || state.generation < lab.state.generation || lab.connected !== 'open') {
        Object.assign(lab, { wanted: 0, news: null });
        stale = true;
        emit('afresh', null);
      }
      connection('open');
      receive('state', state);
    } catch (error) {
      if (stream === mine && error.status !== 401 && error.status !== 0) lab.fail(error);
    }
  }

  function receive(name, value) {
    if (name === 'state') {
      want(value.generation);
      lab.state = value;
      lab.slime = value.slime;
      lab.study = value.study;
      if (value.picture && !(lab.news?.serial > value.picture.serial)) lab.news = value.picture;
      emit('state', value);
      if (stale || !lab.scene || lab.scene.generation < value.generation) fetchScene();
    } else if (name === 'picture') {
      lab.news = value;
      emit('news', value);
    } else {
      lab[name] = value;
      if (lab.state) lab.state[name] = value;
      emit(name, value);
    }
  }

  function refresh() {
    return api.get('/api/state').then((state) => receive('state', state));
  }

  /* Of all that ask while one is under way, one more is sent. */
  async function fetchScene() {
    if (fetching) {
      again = true;
      return;
    }
    fetching = true;
    do {
      again = false;
      stale = false;
      try {
        const scene = await api.get('/api/scene');
        rows = new Map(scene.params.map((row) => [row.path, row]));
        objects = new Map(scene.objects.map((object) => [object.name, object]));
        lab.scene = scene;
        emit('scene', scene);
        await new Promise((resolve) => setTimeout(resolve, SCENE_MS));
      } catch (error) {
        if (error.status) lab.fail(error);
        again = false;
      }
    } while (again && lab.state && lab.scene && lab.scene.generation < lab.state.generation);
    fetching = null;
  }
}
