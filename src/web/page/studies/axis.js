/* One axis of a new study: a parameter, and its values as a list or as a range of numbers.
 * exports: createAxis(lab, {onchange, onremove(axis)}) -> {node, name(number), focus(), problem(text), removable(yes),
 *   text()}
 *   text: PATH=1,2,3 or PATH=FROM..TO:COUNT, as of `cuvette study new --axis`; null, with the problem shown, for an
 *   incomplete axis */

import { say, translated } from '../shared/language.js';
import { createParamPicker } from '../edit/param_picker.js';
import { valueText } from '../edit/param_row.js';
import { numberInput, numberOf } from '../shared/controls.js';
import { button, choice, element, unique } from '../shared/ui.js';

/* Semicolons separate numbers with a decimal comma: 1,33; 1,5. */
function listText(text) {
  if (!text.includes(';')) return text.trim();
  return text
    .split(';')
    .map((value) => value.trim().replace(/^([+-]?\d*),(\d+)$/, '$1.$2'))
    .filter(Boolean)
    .join(',');
}

function labelled(label, input) {
  input.id = unique('axis');
  return element('div', { class: 'axis-number' }, element('label', { for: input.id, text: label }), input);
}

function createRange(onchange) {
  const inputs = [
    ['From', {}],
    ['To', {}],
    ['Count', { min: 2, step: 1, value: '5' }],
  ].map(([label, properties]) => [label, numberInput(properties)]);
  const node = element(
    'div',
    { class: 'axis-range', hidden: true },
    inputs.map(([label, input]) => labelled(label, input)),
  );
  node.addEventListener('input', onchange);
  return {
    node,
    /* The range, or the input whose number is missing or invalid. */
    read() {
      const wrong = inputs.find(([, input]) => !Number.isFinite(numberOf(input)) || !input.checkValidity());
      if (wrong) return { problem: `${wrong[0]}: ${wrong[1].validationMessage || 'enter a number'}`, input: wrong[1] };
      const [from, to, steps] = inputs.map(([, input]) => numberOf(input));
      return { text: `${from}..${to}:${steps}` };
    },
  };
}

export function createAxis(lab, { onchange, onremove }) {
  const trouble = element('p', { class: 'form-problem', role: 'alert', hidden: true });
  const about = element('p', { class: 'hint', id: unique('about') });
  const picker = createParamPicker(lab, { label: 'Parameter', onchoose: chosen });
  const values = element('input', {
    type: 'text',
    class: 'input',
    id: unique('values'),
    placeholder: '1, 1.5, 2 or 1; 1,5; 2',
    'aria-describedby': about.id,
    autocomplete: 'off',
    spellcheck: 'false',
  });
  const list = element(
    'div',
    { class: 'field' },
    element('label', { for: values.id, text: 'Values' }),
    element('span', { class: 'field-control' }, values),
  );
  const range = createRange(changed);
  const how = choice({
    label: 'Given as',
    radios: true,
    value: 'list',
    choices: [
      ['list', 'List'],
      ['range', 'Range'],
    ],
    onchange: () => {
      show();
      changed();
    },
  });
  const remove = button('Remove', () => onremove(axis), { icon: 'trash', bare: true, small: true, kind: 'quiet' });
  const title = element('span', { class: 'axis-title' });
  const node = element(
    'div',
    { class: 'study-axis', role: 'group' },
    element('div', { class: 'axis-head' }, title, remove),
    picker.node,
    how.node,
    list,
    range.node,
    about,
    trouble,
  );
  let known = null;
  const axis = {
    node,
    name(number) {
      title.textContent = say('Axis {number}', { number });
      node.setAttribute('aria-label', title.textContent);
      remove.querySelector('span').textContent = remove.title = say('Remove axis {number}', { number });
    },
    removable(yes) {
      remove.hidden = !yes;
    },
    focus: () => picker.input.focus(),
    problem,
    text,
  };
  values.addEventListener('input', changed);
  show();
  return axis;

  function isRange() {
    return !how.node.hidden && how.value === 'range';
  }

  function show() {
    const row = picker.row;
    how.node.hidden = !row || Boolean(row.choices) || !['real', 'integer'].includes(row.type);
    list.hidden = isRange();
    range.node.hidden = !isRange();
    about.textContent = row
      ? say('{meaning}. {range}; now {value}', {
          meaning: translated(row.meaning),
          range: [row.range, row.unit].filter(Boolean).map(translated).join(', '),
          value: valueText(row.value),
        })
      : '';
  }

  function chosen(row) {
    if (row && row.path !== known && row.choices) values.value = row.choices.join(', ');
    else if (row && row.path !== known && known) values.value = '';
    known = row?.path ?? known;
    show();
    changed();
  }

  function changed() {
    problem(null);
    onchange();
  }

  function problem(words, input = null) {
    trouble.hidden = !words;
    trouble.textContent = words || '';
    for (const each of node.querySelectorAll('[aria-invalid]')) each.removeAttribute('aria-invalid');
    if (!words) return;
    (input || (isRange() ? range.node.querySelector('input') : values)).setAttribute('aria-invalid', 'true');
  }

  function text() {
    const { row } = picker;
    if (!row) {
      problem('Choose a parameter of the scene from the list.', picker.input);
      return null;
    }
    if (isRange()) {
      const read = range.read();
      if (read.problem) problem(read.problem, read.input);
      return read.problem ? null : `${row.path}=${read.text}`;
    }
    const listed = listText(values.value);
    if (!listed) problem('Enter the values, such as 1, 2, 4.', values);
    return listed ? `${row.path}=${listed}` : null;
  }
}
