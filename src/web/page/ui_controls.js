/* Labelled controls. exports: number, text, check, slider, choice (see ui.js)
 * Each is {node, set(value), ..}; set updates the control without calling its listener. */

import { element, gesture, gestures, unique } from './ui_base.js';
import { digits } from './ui_numbers.js';
import { numberInput, numberOf } from './ui_number_input.js';

const shown = (value) => (Number.isFinite(value) ? String(Number(Number(value).toPrecision(7))) : '');

function frame(label, input, unit) {
  input.id ||= unique('input');
  return element(
    'div',
    { class: 'field' },
    element('label', { for: input.id, text: label }),
    element('span', { class: 'field-control' }, input, unit ? element('span', { class: 'unit', text: unit }) : null),
  );
}

export function number({ label, value, min, max, step, unit, onchange }) {
  let last = value;
  const input = numberInput({ min, max, step: step ?? 'any', value: shown(value) });
  input.addEventListener('change', () => {
    if (input.value === '' || !input.checkValidity()) {
      if (input.value === '') input.value = shown(last);
      else input.reportValidity();
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

export function check(label, checked, onchange) {
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

/* Slider positions are 0..steps. logFrom: above 0, logarithmic from there on; position 0 is min. */
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
  const box = numberInput({ value: shown(value), 'aria-label': `${label}, number` });
  let mine = null;
  const presses = gestures('slider');
  let dragged = false;
  const show = (next) => {
    input.value = ruler.position(next);
    input.setAttribute('aria-valuetext', `${digits(next)}${unit ? ` ${unit}` : ''}`);
    input.style.setProperty('--filled', `${(100 * input.value) / ruler.steps}%`);
  };
  input.addEventListener('pointerdown', presses.end);
  input.addEventListener('input', (event) => {
    mine = presses.at(event.timeStamp, '', dragged);
    dragged = true;
    const next = ruler.value(Number(input.value));
    box.value = shown(next);
    show(next);
    oninput?.(next, mine);
  });
  input.addEventListener('change', () => {
    onchange?.(ruler.value(Number(input.value)), mine ?? presses.at(performance.now()));
    dragged = false;
  });
  box.addEventListener('change', () => {
    if (box.value === '') return;
    if (!box.reportValidity()) return;
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
      if (dragged) return;
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
