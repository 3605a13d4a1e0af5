/* The control of one parameter, by its type.
 * exports: controlOf(row, context) -> {node, inputs, single, busy(), set(value)}
 *   context: {name (for screen readers), describedby, send(value, gesture), names: the suggested words, slider() -> the
 *   slider of the newest row, layers(design) -> promise of the layers of a coating}
 *   single: the one input that a label belongs to, or null for a group; busy(): whether the control is being dragged;
 *   set(value, true): after a rejected value
 *   written(x): a number as text with 7 digits; '' for NaN */

import { numberInput, numberOf, restoreField, scale } from '../shared/controls.js';
import { local, say, translated } from '../shared/language.js';
import { sliderDrag } from '../shared/slider_drag.js';
import { element, gesture, toByte, toLinear, unique } from '../shared/ui.js';

const CHANNELS = ['red', 'green', 'blue'];
const AXES = ['x', 'y', 'z'];

export const written = (x) => (Number.isFinite(x) ? String(Number(x.toPrecision(7))) : '');
const digitsOf = (x, n) => Number(x.toPrecision(n));

function attributes(context, label) {
  return { id: unique('param'), 'aria-label': label || context.name, 'aria-describedby': context.describedby };
}

/* A number field that restores the last sent value if it is left empty. */
function numberBox(context, label, onvalue) {
  const input = numberInput(attributes(context, label));
  let last = null;
  input.addEventListener('change', () => {
    if (input.value === '') input.value = local(written(last));
    else if (!input.checkValidity()) restoreField(input, local(written(last)));
    else {
      last = numberOf(input);
      onvalue(last);
    }
  });
  return {
    input,
    set(value) {
      last = value;
      input.value = local(written(value));
    },
  };
}

function slider(row, context, label, send) {
  let ruler = null;
  const range = element('input', { type: 'range', class: 'range', min: 0, step: 1, ...attributes(context, label) });
  const box = numberBox(context, say('{label}, number', { label: label || context.name }), (value) => {
    show(value);
    send(value, gesture('number'));
  });
  const fit = () => {
    const { lowest: min, highest: max, step, log_from: logFrom } = context.slider();
    ruler = { min, max, ...scale({ min, max, step, logFrom }) };
    range.max = ruler.steps;
    box.input.dataset.step = row.type === 'integer' ? 1 : logFrom ? 'any' : written(10 * step);
  };
  const show = (value) => {
    if (!ruler || value > ruler.max || value < ruler.min) fit();
    range.value = ruler.position(value);
    range.setAttribute('aria-valuetext', `${local(written(value))}${row.unit ? ` ${translated(row.unit)}` : ''}`);
    range.style.setProperty('--filled', `${(100 * range.value) / ruler.steps}%`);
  };
  const drag = sliderDrag(range, {
    value: () => ruler.value(Number(range.value)),
    before: () => numberOf(box.input),
    show(value) {
      show(value);
      box.set(value);
    },
    send,
  });
  return {
    nodes: [range, box.input],
    inputs: [range, box.input],
    busy: drag.busy,
    set(value, rescale) {
      if (rescale) fit(); /* not the range of the rejected value */
      show(value);
      if (document.activeElement !== box.input) box.set(value);
    },
  };
}

function scalar(row, context) {
  const one = slider(row, context, null, context.send);
  return { ...one, node: element('span', { class: 'param-slider' }, one.nodes), single: one.inputs[0] };
}

/* A slider with a check box for the row's word for an automatic value; unchecking it restores the last number. */
function orAutomatic(row, context) {
  let number = typeof row.value === 'number' ? row.value : row.lowest;
  const one = slider(row, context, null, context.send);
  const box = element('input', { type: 'checkbox', ...attributes(context, `${context.name}, ${row.automatic}`) });
  const set = (value, rescale) => {
    const automatic = value === row.automatic;
    if (!automatic) number = value;
    box.checked = automatic;
    for (const input of one.inputs) input.disabled = automatic;
    one.set(number, rescale);
  };
  box.addEventListener('change', () => {
    const value = box.checked ? row.automatic : number;
    set(value);
    context.send(value, gesture('choice'));
  });
  const node = element(
    'span',
    { class: 'param-slider' },
    one.nodes,
    element('label', { class: 'param-automatic' }, box, element('span', { text: row.automatic })),
  );
  return { node, inputs: [...one.inputs, box], single: one.inputs[0], busy: one.busy, set };
}

function parts(row, context, names, make) {
  let value = [...row.value];
  const send = (index) => (x, name) => {
    value = value.map((old, at) => (at === index ? x : old));
    context.send(value, name || gesture('number'));
  };
  const all = names.map((name, index) => make(`${context.name}, ${translated(name)}`, send(index)));
  return {
    all,
    set(next, rescale) {
      value = [...next];
      all.forEach((part, index) => part.set(value[index], rescale));
    },
  };
}

function vector(row, context) {
  const three = parts(row, context, AXES, (label, send) => {
    const part = numberBox(context, label, send);
    part.input.dataset.step = written(10 * row.slider.step);
    return {
      ...part,
      set(x) {
        if (document.activeElement !== part.input) part.set(x);
      },
    };
  });
  const node = element(
    'span',
    { class: 'param-vector' },
    three.all.map((part, index) =>
      element(
        'span',
        { class: 'param-axis' },
        element('span', { class: 'axis', 'aria-hidden': 'true', text: AXES[index] }),
        part.input,
      ),
    ),
  );
  return { node, inputs: three.all.map((part) => part.input), single: null, busy: () => false, set: three.set };
}

function channels(row, context) {
  const three = parts(row, context, CHANNELS, (label, send) => slider(row, context, label, send));
  const node = element(
    'span',
    { class: 'param-channels' },
    three.all.map((part, index) =>
      element(
        'span',
        { class: 'param-slider' },
        element('span', { class: `axis channel-${CHANNELS[index]}`, 'aria-hidden': 'true', text: CHANNELS[index][0] }),
        part.nodes,
      ),
    ),
  );
  return {
    node,
    inputs: three.all.flatMap((part) => part.inputs),
    single: null,
    busy: () => three.all.some((part) => part.busy()),
    set: three.set,
  };
}

const hex = (value, bright) =>
  `#${value
    .map((x) =>
      toByte(x / bright)
        .toString(16)
        .padStart(2, '0'),
    )
    .join('')}`;

/* The colour picker is limited to 1, so a brighter colour is divided by its largest channel for the picker. */
function colour(row, context) {
  let bright = 1;
  let mine = null;
  const picker = element('input', {
    type: 'color',
    ...attributes(context, say('{label}, colour', { label: context.name })),
  });
  const three = parts(row, context, CHANNELS, (label, send) => {
    const part = numberBox(context, say('{label}, linear', { label }), send);
    return {
      ...part,
      set(x) {
        if (document.activeElement !== part.input) part.set(x);
      },
    };
  });
  const set = (value) => {
    bright = Math.max(1, ...value);
    if (mine === null) picker.value = hex(value, bright);
    three.set(value);
  };
  picker.addEventListener('input', () => {
    mine ??= gesture('colour');
    const value = [1, 3, 5].map((at) => digitsOf(toLinear(parseInt(picker.value.slice(at, at + 2), 16)) * bright, 4));
    three.set(value);
    context.send(value, mine);
  });
  picker.addEventListener('change', () => {
    mine = null;
  });
  const node = element(
    'span',
    { class: 'param-colour' },
    picker,
    three.all.map((part) => part.input),
  );
  return {
    node,
    inputs: [picker, ...three.all.map((part) => part.input)],
    single: null,
    busy: () => mine !== null,
    set,
  };
}

function switches(row, context) {
  const name = unique('switch');
  const inputs = [...row.choices].reverse().map((word) => {
    const input = element('input', {
      type: 'radio',
      name,
      value: word,
      class: 'visually-hidden',
      'aria-describedby': context.describedby,
    });
    input.addEventListener('change', () => context.send(word, gesture('choice')));
    return input;
  });
  const node = element(
    'span',
    { class: 'segments' },
    inputs.map((input) => element('label', { class: 'segment' }, input, element('span', { text: input.value }))),
  );
  return {
    node,
    inputs,
    single: null,
    busy: () => false,
    set(value) {
      for (const input of inputs) input.checked = input.value === value;
    },
  };
}

function words(row, context) {
  const integer = row.type === 'integer';
  const input = element(
    'select',
    { class: 'input select', ...attributes(context) },
    row.choices.map((word) => element('option', { value: word, translate: 'no', text: word })),
  );
  input.addEventListener('change', () => context.send(integer ? Number(input.value) : input.value, gesture('choice')));
  return {
    node: input,
    inputs: [input],
    single: input,
    busy: () => false,
    set(value) {
      input.value = String(value);
    },
  };
}

const listText = (value) => (Array.isArray(value) ? value.map(written).join(', ') : String(value));

function text(row, context) {
  const list = row.type === 'list';
  const known = context.names?.length
    ? element(
        'datalist',
        { id: unique('known') },
        context.names.map((word) => element('option', { value: word })),
      )
    : null;
  const input = element('input', {
    type: 'text',
    class: 'input',
    spellcheck: 'false',
    autocomplete: 'off',
    placeholder: list ? 'numbers, separated by commas' : 'none',
    list: known?.id,
    ...attributes(context),
  });
  const read = () => {
    const words = input.value.split(/[,;\s]+/).filter(Boolean);
    return list ? words.map((word) => (Number.isFinite(Number(word)) ? Number(word) : word)) : input.value.trim();
  };
  input.addEventListener('change', () => context.send(read(), gesture('text')));
  return {
    node: element('span', { class: 'param-text' }, input, known),
    inputs: [input],
    single: input,
    busy: () => false,
    set(value) {
      if (document.activeElement !== input) input.value = listText(value);
    },
  };
}

/* A coating: none, a design by its name, or layers as text, which begin with those of the design. */
function coating(row, context) {
  const own = 'own layers';
  const select = element(
    'select',
    { class: 'input select', ...attributes(context) },
    ['none', ...row.designs, own].map((word) =>
      element('option', { value: word, translate: word === own ? null : 'no', text: word }),
    ),
  );
  const box = text(row, { ...context, name: say('{label}, layers', { label: context.name }), names: [] });
  let last = 'none';
  const set = (value) => {
    last = value || 'none';
    const known = last === 'none' || row.designs.includes(last);
    select.value = known ? last : own;
    box.node.hidden = known;
    box.set(known ? '' : last);
  };
  select.addEventListener('change', async () => {
    if (select.value !== own) return context.send(select.value, gesture('choice'));
    const layers = last === 'none' ? '' : await context.layers(last);
    box.node.hidden = false;
    box.set(layers);
    box.single.focus();
    return layers && context.send(layers, gesture('choice'));
  });
  return {
    node: element('span', { class: 'param-coating' }, select, box.node),
    inputs: [select, box.single],
    single: select,
    busy: () => false,
    set,
  };
}

export function controlOf(row, context) {
  const made = maker(row)(row, context);
  made.set(row.value);
  return made;
}

function maker(row) {
  if (row.choices)
    return row.choices.length === 2 && row.choices[0] === 'off' && row.choices[1] === 'on' ? switches : words;
  if (row.designs) return coating;
  if (row.type === 'color') return row.coefficient ? channels : colour;
  if (row.type === 'vector') return vector;
  if (row.automatic) return orAutomatic;
  if (row.type === 'real' || row.type === 'integer') return scalar;
  return text;
}
