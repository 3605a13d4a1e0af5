/* What moves along with the selected object: the solids and lights inside it, such as the liquid and the rod of a
 * vessel. The list is asked from the program, and stays as it is during a drag, so that a large solid does not collect
 * what it passes over.
 * exports: createGroup(lab, choice) -> group
 *   group.names                         of what is inside the selected object
 *   group.centre, group.radius          of a ball around the object, relative to its position; null if unknown
 *   group.on, group.set(on)             whether they move along; remembered
 *   group.ready                         a promise: the list is that of the selected object, perhaps not the newest
 *   group.with(gesture)                 the names to send with a change of that gesture
 *   group.onchange(f) */

import { memory } from './ui.js';
import { minus } from './ray_vectors.js';

const LATER_MS = 400;

export function createGroup(lab, choice) {
  const listeners = new Set();
  let frozen = null;
  let asked = '';
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
      tell();
    },
    with: names,
    onchange: (listener) => listeners.add(listener),
  };
  choice.on(() => {
    Object.assign(group, { names: [], centre: null });
    asked = '';
    tell();
    group.ready = ask();
  });
  lab.on('scene', () => {
    clearTimeout(timer);
    timer = setTimeout(askIfNewest, LATER_MS);
  });
  return group;

  /* The object may be gone in a scene that is on its way, whose arrival asks again. */
  function askIfNewest() {
    if (lab.change.idle() && lab.newestGeneration === lab.scene.generation) ask();
  }

  function tell() {
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
    if (key === asked || !['solid', 'light'].includes(object?.kind)) return;
    asked = key;
    await lab.get(`/api/objects/${encodeURIComponent(name)}/contents`).then(
      ({ contents, ball }) => {
        if (choice.name !== name) return;
        const place = lab.param(`${name}.position`)?.value;
        group.names = contents;
        group.centre = ball && place ? minus(ball.centre, place) : null;
        group.radius = ball?.radius || 0;
        tell();
      },
      () => undefined /* it has just been removed or renamed */,
    );
  }
}
