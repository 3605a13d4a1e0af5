/* Sliders for the appearance and the body of a slime.
 * exports: createSliders(lab, solid, mesh) -> {looks: [nodes], body: [nodes], update()}; names of the solid that
 * shows the slime and of its mesh */

import { translated } from '../shared/language.js';
import { element, gesture, slider, toByte, toLinear, unique } from '../shared/ui.js';
import { shortUnit } from './param_row.js';

const CHANNELS = [
  ['red', 0],
  ['green', 1],
  ['blue', 2],
];

/* of: 'solid' or 'mesh'; at: index in a vector; sign: -1 shows the negative */
const looks = [
  { heading: 'Colour', of: 'solid', name: 'color', channels: true },
  {
    label: 'Diffuse fraction',
    of: 'solid',
    name: 'diffuse',
    hint: 'strength of the surface colour; absorption colours transparent slime',
  },
  { label: 'Transmission', of: 'solid', name: 'transparency' },
  { label: 'Refractive index', of: 'solid', name: 'ior' },
  { heading: 'Absorption', of: 'solid', name: 'absorb_per_m', channels: true, tint: true, unit: '1/m' },
];
const body = [
  { label: 'Stiffness', of: 'mesh', name: 'stiffness' },
  { label: 'Damping', of: 'mesh', name: 'damping' },
  { label: 'Gravity', of: 'mesh', name: 'gravity', at: 1, sign: -1 },
  { label: 'Pressure', of: 'mesh', name: 'pressure' },
];

function create(lab, path, { hint, sign = 1, unit }, label, at) {
  const row = lab.param(path);
  const { lowest, highest: max, step, log_from: logFrom } = row.slider;
  const min = sign < 0 ? 0 : lowest;
  const read = () => {
    const value = lab.param(path)?.value;
    const one = at === undefined ? value : value?.[at];
    return Number.isFinite(one) ? sign * one || 0 : min;
  };
  const send = (x, gesture) => {
    const vector = lab.param(path)?.value;
    const value = at === undefined ? sign * x : vector.map((old, index) => (index === at ? sign * x : old));
    if (at !== undefined)
      lab.param(path).value = value; /* the next channel's slider may move before the new scene arrives */
    lab.set({ [path]: value }, gesture).catch(lab.fail);
  };
  const shown = unit || shortUnit(row.unit);
  const one = slider({ label, min, max, step, logFrom, unit: shown, value: read(), oninput: send });
  if (hint) one.node.append(element('span', { class: 'hint', text: hint }));
  return { node: one.node, update: () => one.set(read()) };
}

const DARKEST = 1e-3; /* the transmittance of a channel that is 0 in the chosen colour */

/* The absorption coefficients as the colour of white light after 1 m, by the Beer-Lambert law. */
function tint(lab, path) {
  const input = element('input', { type: 'color', id: unique('tint') });
  let mine = null;
  const update = () => {
    const value = lab.param(path)?.value;
    if (!mine && value)
      input.value = `#${value.map((a) => toByte(Math.exp(-a)).toString(16).padStart(2, '0')).join('')}`;
  };
  input.addEventListener('input', () => {
    mine ??= gesture('tint');
    const left = [1, 3, 5].map((at) => Math.max(DARKEST, toLinear(parseInt(input.value.slice(at, at + 2), 16))));
    lab
      .set({ [path]: left.map((fraction) => Math.max(0, Number((-Math.log(fraction)).toPrecision(4)))) }, mine)
      .catch(lab.fail);
  });
  input.addEventListener('change', () => {
    mine = null;
  });
  update();
  const node = element(
    'div',
    { class: 'field' },
    element('label', { for: input.id, text: 'Tint' }),
    element(
      'span',
      { class: 'field-control' },
      input,
      element('span', { class: 'hint', text: 'colour of white light after 1 m' }),
    ),
  );
  return { node, update };
}

function channels(lab, path, entry) {
  const three = CHANNELS.map(([name, at]) => {
    const one = create(lab, path, entry, `${translated(entry.heading)}, ${translated(name)}`, at);
    one.node
      .querySelector('label')
      .replaceChildren(element('span', { class: `channel channel-${name}`, 'aria-hidden': 'true' }), name);
    one.node.querySelector('.range').setAttribute('aria-label', `${translated(entry.heading)}, ${translated(name)}`);
    return one;
  });
  const all = entry.tint ? [tint(lab, path), ...three] : three;
  const node = element(
    'fieldset',
    { class: 'slime-channels' },
    element('legend', { text: entry.heading }),
    all.map((one) => one.node),
  );
  return { node, update: () => all.forEach((one) => one.update()) };
}

export function createSliders(lab, solid, mesh) {
  const make = (entry) => {
    const path = `${entry.of === 'solid' ? solid : mesh}.${entry.name}`;
    if (!lab.param(path)) return [];
    return [entry.channels ? channels(lab, path, entry) : create(lab, path, entry, entry.label, entry.at)];
  };
  const made = { looks: looks.flatMap(make), body: body.flatMap(make) };
  return {
    looks: made.looks.map((one) => one.node),
    body: made.body.map((one) => one.node),
    update: () => [...made.looks, ...made.body].forEach((one) => one.update()),
  };
}
