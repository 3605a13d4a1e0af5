/* The search for parameters by words of their path, their description or everyday language, as in `cuvette params`; and
 * a field that chooses a parameter with it.
 * exports:
 *   findParams(lab, text, near) -> promise of rows, best first; among equals, the paths in the set near first; count:
 *                                  of all that match; of a large scene only the best rows are returned
 *   createParamPicker(lab, {label, onchoose(row)}) -> {node, input, row}
 *     row: the chosen row of the parameter table, or null while the text is no parameter's path */

import { element, replace, unique } from '../shared/ui.js';

export async function findParams(lab, text, near = new Set()) {
  const { found } = await lab.get(`/api/params?find=${encodeURIComponent(text)}`);
  const best = found.flatMap((paths) => [
    ...paths.filter((path) => near.has(path)),
    ...paths.filter((path) => !near.has(path)),
  ]);
  if (lab.scene?.whole === false) await lab.want('found', best.slice(0, FOUND_MAX));
  const rows = best.map(lab.param).filter(Boolean);
  rows.count = best.length;
  return rows;
}

const FOUND_MAX = 60;

export function createParamPicker(lab, { label, onchoose }) {
  const id = unique('found');
  const input = element('input', {
    type: 'text',
    class: 'input',
    id: unique('param'),
    role: 'combobox',
    'aria-autocomplete': 'list',
    'aria-expanded': 'false',
    'aria-controls': id,
    placeholder: 'Search, such as depth or water',
    autocomplete: 'off',
    spellcheck: 'false',
  });
  const list = element('ul', { class: 'param-found', id, role: 'listbox', 'aria-label': label, hidden: true });
  const node = element(
    'div',
    { class: 'field param-picker' },
    element('label', { for: input.id, text: label }),
    element('span', { class: 'field-control' }, input, list),
  );
  let rows = [];
  let at = -1;
  let answer = null; /* promise of the pending search */

  input.addEventListener('input', () => {
    show();
    onchoose(row());
  });
  input.addEventListener('click', () => list.hidden && show());
  input.addEventListener('blur', hide);
  input.addEventListener('keydown', key);
  /* The field keeps the focus while an option is pressed. */
  list.addEventListener('pointerdown', (event) => event.preventDefault());
  list.addEventListener('click', (event) => {
    const option = event.target.closest('[role=option]');
    if (option) choose(rows[[...list.children].indexOf(option)]);
  });
  return {
    node,
    input,
    get row() {
      return row();
    },
  };

  function row() {
    return lab.param(input.value.trim()) || null;
  }

  async function show() {
    const search = findParams(lab, input.value);
    answer = search;
    try {
      const found = await search;
      if (answer === search) draw(found.slice(0, FOUND_MAX));
    } catch (error) {
      lab.fail(error);
    }
    if (answer === search) answer = null;
  }

  function draw(found) {
    rows = found;
    replace(
      list,
      rows.map((each) =>
        element(
          'li',
          { role: 'option', id: unique('option'), 'aria-selected': 'false' },
          element('code', { text: each.path }),
          element('span', { class: 'hint', text: each.meaning }),
        ),
      ),
    );
    mark(-1);
    list.hidden = !rows.length;
    input.setAttribute('aria-expanded', String(!list.hidden));
  }

  function hide() {
    answer = null;
    list.hidden = true;
    mark(-1);
    input.setAttribute('aria-expanded', 'false');
  }

  function mark(next) {
    list.children[at]?.setAttribute('aria-selected', 'false');
    at = next;
    const option = list.children[at];
    option?.setAttribute('aria-selected', 'true');
    option?.scrollIntoView({ block: 'nearest' });
    if (option) input.setAttribute('aria-activedescendant', option.id);
    else input.removeAttribute('aria-activedescendant');
  }

  function choose(chosen) {
    input.value = chosen.path;
    hide();
    onchoose(chosen);
  }

  function key(event) {
    const direction = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (direction) step(direction);
    else if (event.key === 'Enter' && (answer || (!list.hidden && rows.length))) enter();
    else if (event.key === 'Escape' && (answer || !list.hidden)) {
      hide(); /* the dialog stays open */
      event.stopPropagation();
    } else {
      return;
    }
    event.preventDefault();
  }

  async function step(direction) {
    if (list.hidden) await show();
    if (rows.length && !list.hidden) mark((at + direction + rows.length) % rows.length);
  }

  async function enter() {
    await answer;
    if (rows.length) choose(rows[Math.max(0, at)]);
  }
}
