/* The panel Parameters, generated from the rows of the parameter table: a short list of main parameters, then all
 * parameters by object, and a search.
 * exports: panel */

import { say } from '../shared/language.js';
import { createLongList } from '../shared/long_list.js';
import { button, checkbox, element, empty, group, icon, memory, replace } from '../shared/ui.js';
import { hintOf } from './object_list.js';
import { findParams } from './param_picker.js';
import { createRow, hasLaw, valueText } from './param_row.js';

const FOUND_MAX = 80;
const LATER_MS = 300; /* until the next attempt to rebuild the list, which waits while a control is dragged */
const MANY = 36; /* with more main parameters, only the first groups and Rendering start unfolded */
const LAST = ['camera', 'background', 'render'];
const TITLES = { camera: 'Camera', background: 'Background', render: 'Rendering' };

/* The main parameters; a scene shows only those that it has. */
const MAIN = {
  clear: ['medium', 'ior', 'coefficients', 'color', 'reflectivity', 'transparency', 'absorb_per_m'],
  opaque: ['color', 'reflectivity'],
  light: ['position', 'intensity'],
  render: ['depth', 'lighting', 'samples', 'shadows', 'transmission', 'width', 'height', 'accel', 'threads'],
};

const objectOf = (row) => row.path.slice(0, row.path.length - row.name.length - 1);

function grouped(rows) {
  const groups = new Map();
  for (const row of rows) {
    const name = objectOf(row);
    if (!groups.has(name)) groups.set(name, []);
    groups.get(name).push(row);
  }
  return groups;
}

const rank = { solid: 0, light: 1, material: 2, mesh: 3, texture: 4, data: 5 };

function ordered(names, lab) {
  const place = (name) => (LAST.includes(name) ? 10 + LAST.indexOf(name) : (rank[lab.object(name)?.kind] ?? 5));
  return [...names].sort((a, b) => place(a) - place(b));
}

/* The objects of a kind whose parameters are not all here, because there are too many: a long list, from which a person
 * picks those to show. */
const BIG = [
  ['solid', 'Solids'],
  ['light', 'Lights'],
  ['beam', 'Beams'],
  ['material', 'Materials'],
  ['mesh', 'Meshes'],
];

const bigKinds = (lab, here) =>
  lab.scene.whole === false
    ? BIG.map(([kind, title]) => [title, lab.scene.objects.filter((object) => object.kind === kind)]).filter(
        ([, objects]) => objects.some(({ name }) => !here.has(name)),
      )
    : [];

/* A solid that was transparent once keeps the parameters of clear solids, so that its transparency slider does not
 * vanish while it is dragged. */
function mainParts(lab, onceClear) {
  const here = grouped(lab.scene.params);
  const rowsOf = (name, fields) =>
    fields
      .map((word) => lab.param(`${name}.${word}`))
      .filter((row) => row && (row.name !== 'coefficients' || hasLaw(lab, name)));
  const solids = lab.scene.objects
    .filter(({ kind, name }) => kind === 'solid' && here.has(name))
    .map((object) => object.name);
  for (const name of solids) if ((lab.param(`${name}.transparency`)?.value ?? 0) > 0) onceClear.add(name);
  const isClear = (name) => onceClear.has(name);
  const parts = [
    ...solids.filter(isClear).map((name) => [name, rowsOf(name, MAIN.clear)]),
    ...solids.filter((name) => !isClear(name)).map((name) => [name, rowsOf(name, MAIN.opaque)]),
    ...lab.scene.objects
      .filter(({ kind, name }) => kind === 'light' && here.has(name))
      .map((object) => [object.name, rowsOf(object.name, MAIN.light)]),
    ['render', rowsOf('render', MAIN.render)],
  ];
  return parts.filter(([, rows]) => rows.length);
}

export const panel = {
  id: 'params',
  title: 'Parameters',
  css: 'edit/panel_params.css',

  create(root, lab) {
    const list = element('div', { class: 'param-list' });
    const results = element('div', { class: 'param-list', hidden: true });
    const about = element('div', { class: 'param-about', 'aria-hidden': 'true' });
    const search = element('input', {
      type: 'search',
      class: 'input',
      placeholder: 'Find a parameter',
      'aria-label': 'Find a parameter by name or description',
      spellcheck: 'false',
    });
    const countLabel = element('span', { class: 'visually-hidden', role: 'status' });
    const explain = checkbox('Descriptions', memory.get('meanings', false), (on) => {
      root.classList.toggle('explained', on);
      memory.set('meanings', on);
    });
    const rows = new Map();
    const onceClear = new Set();
    const picked = new Set();
    let built = '';
    let builtOf = null;
    let later = 0;
    let timer = 0;
    let searches = 0;

    root.classList.toggle('explained', explain.value);
    root.append(
      element(
        'div',
        { class: 'param-head' },
        element('div', { class: 'param-search' }, icon('search'), search),
        explain.node,
        countLabel,
      ),
      list,
      results,
      about,
    );
    search.addEventListener('input', () => {
      clearTimeout(timer);
      timer = setTimeout(find, 120);
    });
    search.addEventListener('keydown', (event) => {
      if (event.key !== 'Escape' || !search.value) return;
      search.value = '';
      find();
    });
    lab.on('scene', show);
    describe(null);
    if (lab.scene) show(lab.scene);
    else replace(list, empty('Waiting for the scene …'));

    /* Rows are created for one part of the list ('main', an object's name, 'found') and dropped with it. */
    function make(part, row, long) {
      const made = createRow(row, lab, { onabout: describe, long });
      if (!rows.has(part)) rows.set(part, []);
      rows.get(part).push(made);
      return made.node;
    }

    function describe(row) {
      replace(
        about,
        row
          ? [
              element(
                'p',
                { class: 'about-path' },
                element('code', { text: row.path }),
                element('span', { text: say('default {value}', { value: valueText(row.default) }) }),
              ),
              element('p', { text: row.meaning }),
              element('p', { class: 'about-range', text: [row.range, row.unit].filter(Boolean).join(', ') }),
            ]
          : element('p', { class: 'about-range', text: 'Point at a parameter to read its description.' }),
      );
    }

    function show(scene) {
      const shape = JSON.stringify([
        scene.params.map((row) => [row.path, row.type, row.choices?.length]),
        mainParts(lab, onceClear).map(([name, own]) => [name, own.length]),
      ]);
      const same = shape === built && scene.objects === builtOf;
      if (!same && [...rows.values()].flat().some((made) => made.busy())) {
        clearTimeout(later);
        later = setTimeout(() => show(lab.scene), LATER_MS);
      } else if (!same) {
        [built, builtOf] = [shape, scene.objects];
        build();
      } else {
        for (const part of rows.values()) for (const made of part) update(made, scene);
      }
      const groups = grouped(scene.params);
      for (const node of list.querySelectorAll('.param-group')) mark(node, groups);
    }

    function update(made, scene) {
      const row = lab.param(made.path);
      if (row) made.update(row, scene.generation);
    }

    function build() {
      const focusedRow = document.activeElement?.closest?.('.panel-params .param');
      const focused = focusedRow?.dataset.path;
      const nth = focusedRow ? [...focusedRow.querySelectorAll('input, select')].indexOf(document.activeElement) : -1;
      const place = list.scrollTop;
      rows.clear();
      const here = grouped(lab.scene.params);
      replace(
        list,
        mainGroup(),
        bigKinds(lab, here).map(bigGroup),
        ordered(here.keys(), lab).map((name) => objectGroup(name, here)),
      );
      list.scrollTop = place;
      if (focused && root.contains(document.activeElement) === false) {
        list
          .querySelector(`.param[data-path="${CSS.escape(focused)}"]`)
          ?.querySelectorAll('input, select')
          [nth]?.focus({ preventScroll: true });
      }
      if (search.value) find();
    }

    function mainGroup() {
      const parts = mainParts(lab, onceClear);
      const many = parts.reduce((sum, [, own]) => sum + own.length, 0) > MANY;
      return group(
        'Main parameters',
        { id: 'params.hand' },
        parts.map(([name, own], index) => {
          const open = memory.get(`group.hand.${name}`, !many || index < 2 || name === 'render');
          const node = element(
            'details',
            { class: 'main-part', open },
            element(
              'summary',
              {},
              element('h4', { text: TITLES[name] || name }),
              element('span', { class: 'group-hint', text: hint(name) }),
            ),
            own.map((row) => make('main', row)),
          );
          node.addEventListener('toggle', () => memory.set(`group.hand.${name}`, node.open));
          return node;
        }),
      );
    }

    function hint(name) {
      const object = lab.object(name);
      if (!object) return '';
      return [
        object.kind === 'solid' ? object.shape || 'solid' : object.kind,
        object.material ? say('of {material}', object) : '',
      ]
        .filter(Boolean)
        .join(' ');
    }

    function bigGroup([title, objects]) {
      const long = createLongList({ label: title, item: pickable });
      long.set(objects);
      return group(title, { id: `params.all.${title}`, hint: String(objects.length) }, long.node);
    }

    function pickable(object) {
      const node = element(
        'button',
        { type: 'button', class: 'object-item', 'aria-pressed': String(picked.has(object.name)), onclick: pick },
        element('span', { class: 'object-name', text: object.name }),
        ' ',
        element('span', { class: 'object-hint', text: hintOf(object) }),
      );
      return node;

      function pick() {
        if (!picked.delete(object.name)) {
          picked.add(object.name);
          memory.set(`group.params.${object.name}`, true);
        }
        node.setAttribute('aria-pressed', String(picked.has(object.name)));
        lab.want('params', [...picked]);
      }
    }

    /* A folded group is filled when it is first opened. */
    function objectGroup(name, here) {
      const node = group(TITLES[name] || name, { open: false, id: `params.${name}`, hint: hint(name) });
      const body = node.querySelector('.group-body');
      node.classList.add('param-group');
      node.dataset.object = name;
      node.querySelector('summary').append(element('span', { class: 'changed-count' }));
      const fill = () => {
        if (!node.open || body.childElementCount) return;
        const own = grouped(lab.scene.params).get(name) || [];
        const kinds = [...new Set(own.map((row) => row.group))];
        const titles = { solid: 'Shape and placement', material: 'Material', mesh: 'Mesh', light: 'Light' };
        body.append(
          ...kinds
            .flatMap((kind) => [
              kinds.length > 1 ? element('h4', { class: 'param-kind', text: titles[kind] || kind }) : null,
              ...own.filter((row) => row.group === kind).map((row) => make(name, row)),
            ])
            .filter(Boolean),
          button(say('Reset {name}', { name }), () => resetGroup(name), {
            icon: 'reset',
            small: true,
            kind: 'quiet',
            class: 'button quiet small param-reset-group',
          }),
        );
      };
      node.addEventListener('toggle', fill);
      fill();
      mark(node, here);
      return node;
    }

    function changedRows(name, groups = grouped(lab.scene.params)) {
      return (groups.get(name) || []).filter(
        (row) =>
          row.initial !== null &&
          row.initial !== undefined &&
          JSON.stringify(row.value) !== JSON.stringify(row.initial),
      );
    }

    function mark(node, groups) {
      const many = changedRows(node.dataset.object, groups).length;
      node.querySelector('.changed-count').textContent = many ? say('{n} changed', { n: many }) : '';
      const reset = node.querySelector('.param-reset-group');
      if (reset) reset.hidden = !many;
    }

    function resetGroup(name) {
      lab.change('/api/reset', { paths: changedRows(name).map((row) => row.path) }).catch(lab.fail);
    }

    async function find() {
      const words = search.value.trim();
      searches += 1;
      const mine = searches;
      if (!words) {
        rows.delete('found');
        list.hidden = false;
        results.hidden = true;
        countLabel.textContent = '';
        results.replaceChildren();
        return;
      }
      const mainPaths = new Set(mainParts(lab, onceClear).flatMap(([, own]) => own.map((row) => row.path)));
      try {
        const best = await findParams(lab, words, mainPaths);
        if (mine === searches) showFound(best);
      } catch (error) {
        lab.fail(error);
      }
    }

    function showFound(best) {
      rows.delete('found');
      list.hidden = true;
      results.hidden = false;
      const found = Math.min(FOUND_MAX, best.length);
      countLabel.textContent = say('{n} found', { n: best.count });
      replace(
        results,
        best.length
          ? element('p', {
              class: 'hint',
              text:
                best.count > found
                  ? say('{shown} of {n} found', { shown: found, n: best.count })
                  : say('{n} found', { n: best.count }),
            })
          : empty('No parameter matches in name or description.'),
        best.slice(0, FOUND_MAX).map((row) => make('found', row, true)),
      );
    }
  },
};
