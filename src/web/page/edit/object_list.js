/* The list of all objects of the scene, by kind. exports: createList(lab, choice) -> {node}; hintOf(object): a solid's
 * shape and material, a light's kind */

import { element, empty, replace } from '../shared/ui.js';

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
    return [object.shape, object.material && `of ${object.material}`].filter(Boolean).join(' ');
  return object.kind === 'light' ? object.light : '';
}

export function createList(lab, choice) {
  const node = element('div', { class: 'object-list', tabindex: '-1' });
  const items = new Map();
  let shown = '';

  choice.on(() => mark(true));
  lab.on('scene', build);
  if (lab.scene) build(lab.scene);
  else replace(node, empty('Waiting for the scene …'));
  return { node };

  function build(scene) {
    const now = JSON.stringify(scene.objects);
    if (now === shown) return;
    shown = now;
    const focused = [...items].find(([, button]) => button === document.activeElement)?.[0];
    items.clear();
    replace(
      node,
      element('h2', { class: 'visually-hidden', text: 'Objects of the scene' }),
      KINDS.map(([kind, title]) =>
        part(
          title,
          scene.objects.filter((object) => object.kind === kind),
        ),
      ),
    );
    mark(false);
    if (focused) items.get(focused)?.focus({ preventScroll: true });
  }

  function part(title, objects) {
    if (!objects.length) return null;
    return element(
      'section',
      { 'aria-label': title },
      element('h3', {}, title, ' ', element('span', { class: 'badge', text: String(objects.length) })),
      element(
        'ul',
        {},
        objects.map((object) => element('li', {}, item(object))),
      ),
    );
  }

  function item(object) {
    const button = element(
      'button',
      {
        type: 'button',
        class: 'object-item',
        'aria-pressed': 'false',
        onclick: () => choice.choose(choice.name === object.name ? '' : object.name),
      },
      element('span', { class: 'object-name', text: object.name }),
      ' ',
      element('span', { class: 'object-hint', text: hintOf(object) }),
    );
    items.set(object.name, button);
    return button;
  }

  function mark(scroll) {
    for (const [name, button] of items) button.setAttribute('aria-pressed', String(name === choice.name));
    if (scroll) items.get(choice.name)?.scrollIntoView({ block: 'nearest' });
  }
}
