/* The selected object, shared by the list, its details and the image, and the changes to it.
 *
 * exports: createChoice(lab) -> choice
 *   choice.name, choice.object          '' and undefined for none; a new object may not be in the scene yet
 *   choice.choose(name)                 '' clears the selection
 *   choice.on(f)                        f() after another object is selected or the selected one has vanished
 *   choice.add(body)                    POST /api/objects; selects the new object
 *   choice.addAll(bodies, name, gesture)    several, as one step of Undo; selects the one of that name
 *   choice.move(by, gesture), choice.turn(by, gesture), choice.scale(factor, gesture)
 *                                       change the selected object; waiting changes of one gesture are merged
 *   choice.copy(), choice.remove(), choice.rename(to), choice.setMaterial(material or null)
 *                                       promises of true on success
 *   choice.group                        what moves along with the object
 *     names                             of the solids and lights inside it
 *     centre, radius                    of a ball around the object, relative to its position; null if unknown
 *     on, set(on)                       whether they move along; remembered
 *     ready                             a promise that the list belongs to the selected object; it may be out of date
 *     with(gesture)                     the names to send with a change of that gesture
 *     onchange(f) */

import { say } from '../shared/language.js';
import { memory } from '../shared/ui.js';
import { add, minus } from '../shared/vectors.js';

const join = (waiting, newer) => ({ ...newer, by: add(waiting.by, newer.by) });
const product = (waiting, newer) => ({ ...newer, factor: waiting.factor * newer.factor });

export function createChoice(lab) {
  const listeners = new Set();
  let since = 0; /* the generation in which the selected object first exists */

  const choice = {
    name: '',
    get object() {
      return choice.name ? lab.object(choice.name) : undefined;
    },
    on: (listener) => listeners.add(listener),
    choose,
    add: addObject,
    addAll,
    rename,
    remove,
    copy: () => added(lab.change(at('copy'), {})),
    setMaterial: (material) => succeeds(lab.change(at('material'), { material })),
    move: (by, gesture) => send('move', { by }, gesture, join),
    turn: (by, gesture) => send('turn', { by }, gesture, join),
    scale: (factor, gesture) => send('scale', { factor }, gesture, product),
  };
  choice.group = createGroup(lab, choice);
  lab.on('scene', (scene) => {
    if (choice.name && !lab.object(choice.name) && scene.generation >= since) choose('');
  });
  return choice;

  function at(what) {
    return `/api/objects/${encodeURIComponent(choice.name)}/${what}`;
  }

  /* A drag may begin before the contents of the object are known. */
  async function send(what, body, gesture, merge) {
    const path = at(what);
    await choice.group.ready;
    return succeeds(lab.change(path, { ...body, with: choice.group.with(gesture) }, { gesture, merge }));
  }

  function choose(name, generation = 0) {
    since = generation;
    if (name === choice.name) return;
    choice.name = name;
    lab.want('choice', name ? [name] : []);
    for (const listener of listeners) listener();
  }

  async function succeeds(promise) {
    try {
      await promise;
      return true;
    } catch (error) {
      lab.fail(error);
      return false;
    }
  }

  async function added(promise) {
    try {
      const reply = await promise;
      choose(reply.name, reply.generation);
      lab.say(say('{name} added.', reply));
      return true;
    } catch (error) {
      lab.fail(error);
      return false;
    }
  }

  function addObject(body) {
    return added(lab.change('/api/objects', body));
  }

  function addAll(bodies, name, gesture) {
    const replies = Promise.all(bodies.map((body) => lab.change('/api/objects', { ...body, gesture })));
    return added(replies.then((all) => ({ ...all[all.length - 1], name })));
  }

  async function rename(to) {
    const { name } = choice;
    try {
      const reply = await lab.change(at('rename'), { to });
      if (choice.name === name) choose(to, reply.generation);
      return true;
    } catch (error) {
      lab.fail(error);
      return false;
    }
  }

  async function remove() {
    const { name } = choice;
    if (!name || !(await succeeds(lab.del(`/api/objects/${encodeURIComponent(name)}`)))) return false;
    choose('');
    lab.say(say('{name} removed. Undo restores it.', { name }));
    return true;
  }
}

const LATER_MS = 400;
const MARKED_MAX = 40; /* of the objects that move along, those whose outlines are drawn in a large scene */

function createGroup(lab, choice) {
  const listeners = new Set();
  let frozen = null;
  let requested = '';
  let timer = 0;

  const group = {
    names: [],
    centre: null,
    radius: 0,
    on: memory.get('object.contents', true),
    ready: Promise.resolve(),
    set(on) {
      group.on = on;
      memory.set('object.contents', on);
      frozen = null;
      notify();
    },
    with: names,
    onchange: (listener) => listeners.add(listener),
  };
  choice.on(() => {
    Object.assign(group, { names: [], centre: null });
    requested = '';
    notify();
    group.ready = ask();
  });
  lab.on('scene', () => {
    clearTimeout(timer);
    timer = setTimeout(askIfNewest, LATER_MS);
  });
  return group;

  /* Requests the list only for the newest scene. A newer scene that is on its way may lack the object; its arrival
   * calls this function again. */
  function askIfNewest() {
    if (lab.change.idle() && lab.newestGeneration === lab.scene.generation) ask();
  }

  function notify() {
    for (const listener of listeners) listener();
  }

  function names(name) {
    if (!frozen || frozen.name !== name || frozen.of !== choice.name)
      frozen = { name, of: choice.name, names: group.on ? [...group.names] : [] };
    return frozen.names;
  }

  async function ask() {
    const { name, object } = choice;
    const key = `${name} ${lab.state?.generation}`;
    if (key === requested || !['solid', 'light'].includes(object?.kind)) return;
    requested = key;
    await lab.get(`/api/objects/${encodeURIComponent(name)}/contents`).then(
      async ({ contents, ball }) => {
        if (choice.name !== name) return;
        await lab.want('choice', [name, ...contents.slice(0, MARKED_MAX)]);
        if (choice.name !== name) return;
        const place = lab.param(`${name}.position`)?.value;
        group.names = contents;
        group.centre = ball && place ? minus(ball.centre, place) : null;
        group.radius = ball?.radius || 0;
        notify();
      },
      () => undefined /* it has just been removed or renamed */,
    );
  }
}
