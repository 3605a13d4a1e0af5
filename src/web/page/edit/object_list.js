/* The list of all objects of the scene, by kind, with a field to find them by name when there are many. exports:
 * createList(lab, choice) -> {node}; hintOf(object): a solid's shape and material, a light's kind */

import { say } from '../shared/language.js';
import { createLongList } from '../shared/long_list.js';
import { element, empty, replace } from '../shared/ui.js';

const MANY = 40;

const KINDS = [
  ['solid', 'Solids'],
  ['light', 'Lights'],
  ['beam', 'Beams'],
  ['material', 'Materials'],
  ['mesh', 'Meshes'],
  ['texture', 'Textures'],
  ['data', 'Optical data'],
];

export function hintOf(object) {
  if (object.kind === 'solid')
    return [object.shape, object.material && say('of {material}', object)].filter(Boolean).join(' ');
  return object.kind === 'light' ? object.light : '';
}

export function createList(lab, choice) {
  const list = element('div', { class: 'object-list', tabindex: '-1' });
  const search = element('input', {
    type: 'search',
    class: 'input object-search',
    placeholder: 'Find an object',
    'aria-label': 'Find an object by name',
    spellcheck: 'false',
    hidden: true,
  });
  const node = element('div', {}, search, list);
  const items = new Map(); /* of the short lists */
  let long = [];
  let shown = null; /* the objects, and the words, of which the list was built */
  let words = '';

  search.addEventListener('input', () => build(lab.scene));
  choice.on(() => mark(true));
  lab.on('scene', build);
  if (lab.scene) build(lab.scene);
  else replace(list, empty('Waiting for the scene …'));
  return { node };

  function build(scene) {
    const now = search.value.trim().toLowerCase();
    if (scene.objects === shown && now === words) return;
    [shown, words] = [scene.objects, now];
    const focused = [...items].find(([, button]) => button === document.activeElement)?.[0];
    const found = words ? scene.objects.filter(({ name }) => name.toLowerCase().includes(words)) : scene.objects;
    items.clear();
    search.hidden = scene.objects.length <= MANY;
    long = [];
    replace(
      list,
      element('h2', { class: 'visually-hidden', text: 'Objects of the scene' }),
      found.length ? null : empty('No object has this name.'),
      KINDS.map(([kind, title]) =>
        part(
          title,
          found.filter((object) => object.kind === kind),
        ),
      ),
    );
    for (const each of long) each.list.set(each.objects);
    mark(false);
    if (focused) items.get(focused)?.focus({ preventScroll: true });
  }

  function part(title, objects) {
    if (!objects.length) return null;
    return element(
      'section',
      { 'aria-label': title },
      element('h3', {}, title, ' ', element('span', { class: 'badge', text: String(objects.length) })),
      objects.length > MANY ? longList(title, objects) : shortList(objects),
    );
  }

  function shortList(objects) {
    return element(
      'ul',
      {},
      objects.map((object) => {
        const button = item(object);
        items.set(object.name, button);
        return element('li', {}, button);
      }),
    );
  }

  function longList(title, objects) {
    const made = createLongList({ label: title, item, scroller: list });
    long.push({ list: made, objects });
    return made.node;
  }

  function item(object) {
    return element(
      'button',
      {
        type: 'button',
        class: 'object-item',
        'aria-pressed': String(object.name === choice.name),
        onclick: () => choice.choose(choice.name === object.name ? '' : object.name),
      },
      element('span', { class: 'object-name', translate: 'no', text: object.name }),
      ' ',
      element('span', { class: 'object-hint', text: hintOf(object) }),
    );
  }

  function mark(scroll) {
    const press = (name, button) => button.setAttribute('aria-pressed', String(name === choice.name));
    for (const [name, button] of items) press(name, button);
    if (scroll) items.get(choice.name)?.scrollIntoView({ block: 'nearest' });
    for (const each of long) {
      if (scroll && choice.name) each.list.reveal(choice.name);
      each.list.each(press);
    }
  }
}
