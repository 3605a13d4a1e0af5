/* Sliders for how a slime looks and how it is made.
 * exports: createSliders(lab, solid, mesh) -> {looks: [nodes], body: [nodes], update()}; names of the solid that shows it and of its mesh */

import {slider, element} from './ui.js';

const CHANNELS = [['red', 0], ['green', 1], ['blue', 2]];

/* of: 'solid' or 'mesh'; at: which element of a list; sign: -1 shows the negative */
const looks = [
  {heading: 'Colour', of: 'solid', name: 'color', channels: true, min: 0, max: 1, step: 0.005},
  {label: 'Diffuse share', of: 'solid', name: 'diffuse', min: 0, max: 1, step: 0.005, hint: 'how much of the colour is seen; clear slime is coloured by what it absorbs'},
  {label: 'Transmission', of: 'solid', name: 'transparency', min: 0, max: 1, step: 0.005},
  {label: 'Index', of: 'solid', name: 'ior', min: 1, max: 2.5, step: 0.005},
  {heading: 'Absorption', of: 'solid', name: 'absorb_per_m', channels: true, min: 0, max: 100, log: true, unit: '1/m'},
];
const body = [
  {label: 'Stiffness', of: 'mesh', name: 'stiffness', min: 0, max: 200, log: true, unit: 'N/u'},
  {label: 'Damping', of: 'mesh', name: 'damping', min: 0, max: 2, log: true, unit: 'N s/u'},
  {label: 'Gravity', of: 'mesh', name: 'gravity', at: 1, sign: -1, min: 0, max: 30, step: 0.05, unit: 'u/s²'},
  {label: 'Pressure', of: 'mesh', name: 'pressure', min: 0, max: 5000, log: true, unit: 'N/u²'},
];

function create(lab, path, entry, label, at) {
  const {min, max, step, log, unit, hint, sign = 1} = entry;
  const read = () => {
    const value = lab.param(path)?.value;
    const one = at === undefined ? value : value?.[at];
    return Number.isFinite(one) ? sign * one || 0 : min;
  };
  const send = (x, gesture) => {
    const whole = lab.param(path)?.value;
    const value = at === undefined ? sign * x : whole.map((old, index) => (index === at ? sign * x : old));
    if (at !== undefined) lab.param(path).value = value; /* the next channel's slider may come before the scene does */
    lab.set({[path]: value}, gesture).catch(lab.fail);
  };
  const one = slider({label, min, max, step, log, unit, value: read(), oninput: send});
  if (hint) one.node.append(element('span', {class: 'hint', text: hint}));
  return {node: one.node, update: () => one.set(read())};
}

function channels(lab, path, entry) {
  const three = CHANNELS.map(([name, at]) => {
    const one = create(lab, path, entry, `${entry.heading}, ${name}`, at);
    one.node.querySelector('label').replaceChildren(element('span', {class: `channel channel-${name}`, 'aria-hidden': 'true'}), name);
    one.node.querySelector('.range').setAttribute('aria-label', `${entry.heading}, ${name}`);
    return one;
  });
  const node = element('fieldset', {class: 'slime-channels'}, element('legend', {text: entry.heading}), three.map((one) => one.node));
  return {node, update: () => three.forEach((one) => one.update())};
}

export function createSliders(lab, solid, mesh) {
  const make = (entry) => {
    const path = `${entry.of === 'solid' ? solid : mesh}.${entry.name}`;
    if (!lab.param(path)) return [];
    return [entry.channels ? channels(lab, path, entry) : create(lab, path, entry, entry.label, entry.at)];
  };
  const made = {looks: looks.flatMap(make), body: body.flatMap(make)};
  return {
    looks: made.looks.map((one) => one.node), body: made.body.map((one) => one.node),
    update: () => [...made.looks, ...made.body].forEach((one) => one.update()),
  };
}
