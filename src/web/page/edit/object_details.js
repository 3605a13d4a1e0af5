/* The details of the selected object: name, material, steps for position and direction, its file, and all its
 * parameters. Lights can be paged through.
 * exports:
 *   createDetails(lab, choice, files) -> {node}
 *   presetChoices(lab) -> [[word, label], ..]     for solids: '' is a painted surface, other words are media and the
 *                                                 scene's own materials
 *   presetValues(word) -> {ROW: VALUE}            for POST /api/objects */

import { say } from '../shared/language.js';
import { button, choice as choiceOf, element, empty, group, replace, text } from '../shared/ui.js';
import { hintOf } from './object_list.js';
import { createPads } from './object_pads.js';
import { createRow } from './param_row.js';

/* --- media for new and existing solids, by everyday names ---
 * The indices are those of the program's catalogue (cuvette media); the highlight is as in the clear media of
 * rod.yaml. */

const CLEAR = {
  transparency: 1,
  color: [1, 1, 1],
  ambient: 0,
  diffuse: 0,
  reflectivity: 0,
  specular: 0.6,
  shininess: 80,
  absorb_per_m: [0, 0, 0],
};

/* Absorption of pure water at 640, 550 and 460 nm: Pope and Fry, Appl. Opt. 36, 8710 (1997). */
const MEDIA = {
  glass: { label: 'Glass (BK7)', values: { ...CLEAR, medium: 'bk7' } },
  water: { label: 'Water', values: { ...CLEAR, medium: 'water', absorb_per_m: [0.3108, 0.0565, 0.00979] } },
  oil: { label: 'Olive oil', values: { ...CLEAR, medium: 'olive-oil' } },
  acrylic: { label: 'Acrylic glass', values: { ...CLEAR, medium: 'pmma' } },
  diamond: { label: 'Diamond', values: { ...CLEAR, medium: 'diamond' } },
};

const OF_SCENE = 'material ';

export function presetChoices(lab) {
  const materials = (lab.scene?.objects || []).filter((object) => object.kind === 'material');
  return [
    ['', 'Paint'],
    ...Object.entries(MEDIA).map(([word, { label }]) => [word, label]),
    ...materials.map(({ name }) => [OF_SCENE + name, say('Material {name}', { name })]),
  ];
}

export function presetValues(word) {
  if (word.startsWith(OF_SCENE)) return { material: word.slice(OF_SCENE.length) };
  return MEDIA[word]?.values || {};
}

const mediaChoices = () => Object.entries(MEDIA).map(([word, { label }]) => [word, label]);

/* --- the selected object --- */

const GROUPS = {
  solid: 'Shape and placement',
  material: 'Material',
  mesh: 'Mesh',
  light: 'Light',
  beam: 'Beam',
  texture: 'Texture',
  data: 'Optical data',
};
const OWN = '(own material)';

/* Identifies a control, also after it is recreated. */
function keyOf(control) {
  const path = control.closest('.param')?.dataset.path || '';
  return [
    control.tagName,
    path,
    control.getAttribute('aria-label') || control.labels?.[0]?.textContent || control.textContent,
  ].join('|');
}

export function createDetails(lab, choice, files) {
  const node = element('section', { class: 'object-details', 'aria-label': 'Selected object' });
  const pads = createPads(choice);
  let rows = [];
  let shown = '';

  choice.on(() => show());
  lab.on('scene', show);
  show();
  return { node };

  function ownRows() {
    return (lab.scene?.params || []).filter((row) => row.path === `${choice.name}.${row.name}`);
  }

  function show() {
    const { object } = choice;
    if (!object && choice.name) return; /* the object is not in the scene yet */
    if (!object) {
      if (shown !== 'none') replace(node, empty('Select an object in the list, or in the image with the tool Object.'));
      shown = 'none';
      rows = [];
      return;
    }
    const own = ownRows();
    const others = lab.scene.objects
      .filter((each) => ['material', 'light'].includes(each.kind))
      .map((each) => each.name);
    const now = JSON.stringify([object, own.map((row) => [row.path, row.type, row.choices?.length]), others]);
    if (now === shown) {
      for (const row of rows) if (lab.param(row.path)) row.update(lab.param(row.path), lab.scene.generation);
      return;
    }
    shown = now;
    build(object, own);
  }

  function build(object, own) {
    const focused = node.contains(document.activeElement) ? keyOf(document.activeElement) : null;
    replace(
      node,
      head(object),
      object.kind === 'light' ? pager(object) : null,
      general(object),
      files.forObject(object),
      object.kind === 'solid' || object.kind === 'light'
        ? pads.show({ turns: object.kind === 'solid' || object.light !== 'point', scales: true })
        : null,
      parameters(object, own),
    );
    if (focused)
      [...node.querySelectorAll('button, input, select')]
        .find((each) => keyOf(each) === focused)
        ?.focus({ preventScroll: true });
  }

  function head(object) {
    return element(
      'div',
      { class: 'object-head' },
      element('h2', { translate: 'no', text: object.name }),
      element('span', { class: 'hint', text: [object.kind, hintOf(object)].filter(Boolean).join(', ') }),
      element(
        'span',
        { class: 'buttons' },
        button('Copy', () => choice.copy(), { icon: 'duplicate', small: true, title: 'Add a copy next to it' }),
        button('Remove', remove, { icon: 'trash', small: true, kind: 'danger' }),
      ),
    );
  }

  function pager(object) {
    const lights = lab.scene.objects.filter((each) => each.kind === 'light').map((each) => each.name);
    const here = lights.indexOf(object.name);
    const to = (step) => choice.choose(lights[(here + step + lights.length) % lights.length]);
    const single = lights.length < 2;
    return element(
      'div',
      { class: 'buttons object-pager', role: 'group', 'aria-label': 'Lights' },
      button('Previous light', () => to(-1), { icon: 'earlier', small: true, disabled: single }),
      element('span', { class: 'hint', text: say('{part} of {all}', { part: here + 1, all: lights.length }) }),
      button('Next light', () => to(1), { icon: 'later', small: true, disabled: single }),
      button('Add light', () => choice.add({ kind: 'light' }), { icon: 'plus', small: true }),
    );
  }

  async function remove() {
    if (await choice.remove()) node.parentElement?.querySelector('.object-list')?.focus();
  }

  function general(object) {
    const name = text({
      label: 'Name',
      value: object.name,
      onchange: async (to) => {
        if (to && to !== object.name && (await choice.rename(to))) return;
        name.input.value = object.name;
      },
    });
    name.input.maxLength = 63;
    const materials = lab.scene.objects.filter((each) => each.kind === 'material').map((each) => each.name);
    const material =
      object.kind === 'solid'
        ? choiceOf({
            label: 'Material',
            choices: [['', OWN], ...materials],
            value: object.material || '',
            onchange: (word) => choice.setMaterial(word || null),
          })
        : null;
    const media = ['solid', 'material'].includes(object.kind)
      ? choiceOf({
          label: 'Set to',
          choices: [['', 'a medium …'], ...mediaChoices()],
          value: '',
          onchange: (word) => setMedium(object.name, word),
        })
      : null;
    const parts = [object.material, object.mesh].filter(Boolean);
    return element(
      'div',
      { class: 'object-general' },
      name.node,
      material?.node,
      media?.node,
      parts.length
        ? element(
            'div',
            { class: 'buttons' },
            parts.map((part) =>
              button(say('Go to {name}', { name: part }), () => choice.choose(part), {
                icon: 'later',
                small: true,
                kind: 'quiet',
              }),
            ),
          )
        : null,
    );
  }

  function setMedium(name, word) {
    const values = Object.entries(presetValues(word)).map(([row, value]) => [`${name}.${row}`, value]);
    if (values.length) lab.set(Object.fromEntries(values)).catch(lab.fail);
  }

  function parameters(object, own) {
    const kinds = [...new Set(own.map((row) => row.group))];
    rows = [];
    /* The same layout as in the parameters panel. */
    return element(
      'div',
      { class: 'panel-params object-rows' },
      kinds.map((kind) => {
        const controls = own.filter((row) => row.group === kind).map((row) => createRow(row, lab));
        rows.push(...controls);
        const note =
          kind === 'material' && object.kind === 'solid' && object.material
            ? say('of {material}; values set here apply to {name} only', object)
            : null;
        return group(
          GROUPS[kind] || kind,
          { id: `edit.${kind}`, hint: note },
          controls.map((row) => row.node),
        );
      }),
    );
  }
}
