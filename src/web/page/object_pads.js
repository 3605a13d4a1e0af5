/* Exact steps: the chosen object moves and turns along the world's axes. exports: createPads(lab, choice) -> {show(object) -> node} */

import {button, element, gesture, memory, number} from './ui.js';

const AXES = ['x', 'y', 'z'];
const PAUSE_MS = 800;

export function createPads(lab, choice) {
  const steps = {length: memory.get('object.length', 0.1), angle: memory.get('object.angle', 15)};
  let last = null;

  /* Presses of one button that follow each other are one step of undo. */
  function nameOf(what) {
    const now = performance.now();
    if (!last || last.what !== what || now - last.at > PAUSE_MS) last = {what, gesture: gesture('step')};
    last.at = now;
    return last.gesture;
  }

  function pad(label, size, act) {
    return element('div', {class: 'pad object-pad', role: 'group', 'aria-label': label}, AXES.flatMap((axis, index) => [-1, 1].map((sign) => {
      const by = () => AXES.map((_, at) => (at === index ? sign * steps[size] : 0));
      const face = `${sign < 0 ? '\u2212' : '+'}${axis}`;
      return button(face, () => act(by(), nameOf(`${choice.name} ${label} ${face}`)), {small: true, title: `${label} by ${face}`, 'aria-label': `${label} by ${sign < 0 ? 'minus' : 'plus'} ${axis}`});
    })));
  }

  function field(label, size, unit, max) {
    return number({label, value: steps[size], min: 0.0001, max, unit, onchange: (value) => {
      steps[size] = value;
      memory.set(`object.${size}`, value);
    }}).node;
  }

  return {
    show(object) {
      const turns = object.kind === 'solid' || object.light !== 'point';
      return element('div', {class: 'object-steps'},
        field('Step', 'length', 'units', 1e6), pad('Move', 'length', choice.move),
        turns ? [field('Angle', 'angle', '°', 360), pad('Turn', 'angle', choice.turn)] : null);
    },
  };
}
