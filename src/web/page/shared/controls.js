/* Labelled controls: number, text, checkbox, slider, choice (see ui.js). Each is {node, set(value), ..}; set updates
 * the control without calling its listener.
 * exports: these, and
 *   numberInput({min, max, step, ..attributes}) -> input     the input of a number field; arrow keys change it by a
 *                                                            step; step 'any' means 1
 *   numberOf(input)                                          its number; NaN for an empty field or another text
 *   restoreField(input, text)                                marks a wrong entry, with its reason; restores the text
 *   scale({min, max, step, logFrom})                         the positions of a slider */

import { element, gesture, unique } from './elements.js';
import { local, say, translated } from './language.js';
import { digits } from './numbers.js';
import { sliderDrag } from './slider_drag.js';

/* --- the input of a number field ---
 * It accepts a decimal comma as well as a point, in every language of the browser: an input of type number drops one of
 * them, so that 1,5 becomes 15. */

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

/* A thousands separator is rejected: 1,234.5 and 1.234,5 would be read as different numbers in different countries. */
function parse(text) {
  const plain = text
    .trim()
    .replace(/^\u2212/, '-')
    .replace(',', '.');
  return NUMBER.test(plain) ? Number(plain) : NaN;
}

export const numberOf = (input) => parse(input.value);

function problem(input) {
  if (input.value.trim() === '') return '';
  const value = numberOf(input);
  const { min, max, step } = input.dataset;
  if (!Number.isFinite(value)) return say('Enter a number, such as 1.5 or 1,5, without thousands separators.');
  if (min !== undefined && value < Number(min))
    return say('Enter a number of at least {least}.', { least: local(min) });
  if (max !== undefined && value > Number(max)) return say('Enter a number of at most {most}.', { most: local(max) });
  if (step === '1' && !Number.isInteger(value)) return say('Enter a whole number.');
  return '';
}

function stepped(input, sign) {
  const { min = -Infinity, max = Infinity, step } = input.dataset;
  const by = Number(step) > 0 ? Number(step) : 1;
  const next = (numberOf(input) || 0) + sign * by;
  return Number(Math.min(Number(max), Math.max(Number(min), next)).toPrecision(12));
}

export function numberInput({ min, max, step = 'any', class: name = 'input numeric', ...attributes } = {}) {
  const input = element('input', {
    type: 'text',
    role: 'spinbutton',
    /* The keypad of decimals has no minus on some telephones. */
    inputmode: min >= 0 ? 'decimal' : 'text',
    autocomplete: 'off',
    spellcheck: 'false',
    class: name,
    'aria-valuemin': Number.isFinite(min) ? min : null,
    'aria-valuemax': Number.isFinite(max) ? max : null,
    ...attributes,
  });
  if (Number.isFinite(min)) input.dataset.min = min;
  if (Number.isFinite(max)) input.dataset.max = max;
  input.dataset.step = step;
  const check = () => {
    const value = numberOf(input);
    input.setCustomValidity(problem(input));
    if (Number.isFinite(value)) input.setAttribute('aria-valuenow', value);
    else input.removeAttribute('aria-valuenow');
  };
  for (const event of ['focus', 'input', 'change']) input.addEventListener(event, check);
  input.addEventListener('keydown', (event) => {
    const sign = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!sign || event.ctrlKey || event.altKey || event.metaKey || input.disabled) return;
    input.value = local(String(stepped(input, sign)));
    for (const type of ['input', 'change']) input.dispatchEvent(new Event(type, { bubbles: true }));
    event.preventDefault();
  });
  return input;
}

/* --- controls --- */

const shown = (value) => (Number.isFinite(value) ? local(String(Number(Number(value).toPrecision(7)))) : '');

function frame(label, input, unit) {
  input.id ||= unique('input');
  return element(
    'div',
    { class: 'field' },
    element('label', { for: input.id, text: label }),
    element('span', { class: 'field-control' }, input, unit ? element('span', { class: 'unit', text: unit }) : null),
  );
}

/* A wrong entry is marked, and the last right one restored, with the reason until the next entry. */
export function restoreField(input, text) {
  const place = input.closest('.field, .param, .camera-field') || input.parentElement;
  const reason = input.validationMessage || problem(input);
  const typed = input.value;
  forgive(input);
  input.value = text;
  input.setCustomValidity('');
  input.setAttribute('aria-invalid', 'true');
  const why = say('{typed} was not taken: {reason} The field has its last value again.', { typed, reason });
  place.append(element('p', { class: 'field-problem', role: 'alert', text: why }));
  input.addEventListener('input', () => forgive(input), { once: true });
}

function forgive(input) {
  const place = input.closest('.field, .param, .camera-field') || input.parentElement;
  input.removeAttribute('aria-invalid');
  place.querySelector(':scope > .field-problem')?.remove();
}

export function number({ label, value, min, max, step, unit, onchange }) {
  let last = value;
  const input = numberInput({ min, max, step: step ?? 'any', value: shown(value) });
  input.addEventListener('change', () => {
    if (input.value === '' || !input.checkValidity()) {
      if (input.value === '') input.value = shown(last);
      else restoreField(input, shown(last));
      return;
    }
    last = numberOf(input);
    onchange?.(last);
  });
  input.addEventListener('blur', () => {
    input.value = shown(last);
  }); /* restores the last valid value */
  const set = (next) => {
    last = next;
    if (document.activeElement !== input || input.value === '') input.value = shown(next);
  };
  return {
    node: label ? frame(label, input, unit) : input,
    input,
    set,
    get value() {
      return numberOf(input);
    },
  };
}

export function text({ label, value = '', placeholder, onchange }) {
  const input = element('input', {
    type: 'text',
    class: 'input',
    value,
    placeholder,
    spellcheck: 'false',
    autocomplete: 'off',
  });
  input.addEventListener('change', () => onchange?.(input.value));
  const set = (next) => {
    if (document.activeElement !== input) input.value = next;
  };
  return {
    node: label ? frame(label, input) : input,
    input,
    set,
    get value() {
      return input.value;
    },
  };
}

export function checkbox(label, checked, onchange) {
  const input = element('input', { type: 'checkbox', checked });
  input.addEventListener('change', () => onchange?.(input.checked));
  const node = element('label', { class: 'check' }, input, element('span', { text: label }));
  return {
    node,
    input,
    set(next) {
      input.checked = next;
    },
    get value() {
      return input.checked;
    },
  };
}

/* Slider positions are 0..steps. With logFrom > 0 the positions above 0 are logarithmic from logFrom to max, and
 * position 0 is min. */
export function scale({ min, max, step, logFrom }) {
  const integer = step >= 1;
  const steps = !logFrom && step && (max - min) / step <= 1000 ? Math.round((max - min) / step) : 1000;
  const tidy = (x) => {
    if (integer) return Math.round(x);
    return logFrom ? Number(x.toPrecision(3)) : Number(Number((Math.round(x / step) * step).toPrecision(10)));
  };
  return {
    steps,
    position(value) {
      if (!logFrom) return Math.round(steps * Math.min(1, Math.max(0, (value - min) / (max - min))));
      if (value <= logFrom) return 0;
      return Math.round(steps * Math.min(1, Math.log(value / logFrom) / Math.log(max / logFrom)));
    },
    value(position) {
      if (position <= 0) return min;
      if (position >= steps) return max;
      return tidy(logFrom ? logFrom * (max / logFrom) ** (position / steps) : min + (max - min) * (position / steps));
    },
  };
}

export function slider({ label, min, max, step = (max - min) / 200, value, logFrom = 0, unit, oninput, onchange }) {
  const ruler = scale({ min, max, step, logFrom });
  const input = element('input', {
    type: 'range',
    class: 'range',
    min: 0,
    max: ruler.steps,
    step: 1,
    id: unique('range'),
  });
  const box = numberInput({ value: shown(value), 'aria-label': say('{label}, number', { label: translated(label) }) });
  const show = (next) => {
    input.value = ruler.position(next);
    input.setAttribute('aria-valuetext', `${digits(next)}${unit ? ` ${unit}` : ''}`);
    input.style.setProperty('--filled', `${(100 * input.value) / ruler.steps}%`);
  };
  const drag = sliderDrag(input, {
    value: () => ruler.value(Number(input.value)),
    before: () => numberOf(box),
    show(next) {
      box.value = shown(next);
      show(next);
    },
    send: (next, name) => oninput?.(next, name),
    rest: (next, name) => onchange?.(next, name),
  });
  box.addEventListener('change', () => {
    if (box.value === '') return;
    if (!box.checkValidity()) {
      restoreField(box, shown(ruler.value(Number(input.value))));
      return;
    }
    const next = numberOf(box);
    show(next);
    const once = gesture('number');
    oninput?.(next, once);
    onchange?.(next, once);
  });
  show(value);
  const node = element(
    'div',
    { class: 'field' },
    element('label', { for: input.id, text: label }),
    element(
      'span',
      { class: 'field-control' },
      input,
      box,
      unit ? element('span', { class: 'unit', text: unit }) : null,
    ),
  );
  return {
    node,
    input,
    box,
    set(next) {
      if (drag.busy()) return;
      show(next);
      if (document.activeElement !== box) box.value = shown(next);
    },
    get value() {
      return numberOf(box);
    },
  };
}

const pair = (entry) => (Array.isArray(entry) ? entry : [entry, String(entry)]);

function radioGroup({ label, choices, value, onchange }) {
  const name = unique('radio');
  const inputs = new Map();
  const buttons = choices.map(pair).map(([word, title]) => {
    const input = element('input', {
      type: 'radio',
      name,
      value: word,
      checked: word === value,
      class: 'visually-hidden',
    });
    input.addEventListener('change', () => onchange?.(word));
    inputs.set(word, input);
    return element('label', { class: 'segment' }, input, element('span', { text: title }));
  });
  const node = element('div', { class: 'segments', role: 'radiogroup', 'aria-label': label }, buttons);
  return {
    node,
    inputs,
    set(next) {
      for (const [word, input] of inputs) input.checked = word === next;
    },
    get value() {
      return [...inputs].find(([, input]) => input.checked)?.[0];
    },
  };
}

export function choice({ label, choices, value, radios = false, onchange }) {
  if (radios) {
    const group = radioGroup({ label, choices, value, onchange });
    const node = element(
      'div',
      { class: 'field' },
      element('span', { class: 'label', 'aria-hidden': 'true', text: label }),
      element('span', { class: 'field-control' }, group.node),
    );
    return {
      node,
      group: group.node,
      inputs: group.inputs,
      set: group.set,
      get value() {
        return group.value;
      },
    };
  }
  const input = element(
    'select',
    { class: 'input select' },
    choices.map(pair).map(([word, title]) => element('option', { value: word, selected: word === value, text: title })),
  );
  input.addEventListener('change', () => onchange?.(input.value));
  return {
    node: frame(label, input),
    input,
    set(next) {
      input.value = next;
    },
    get value() {
      return input.value;
    },
  };
}
