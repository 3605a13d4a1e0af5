/* Buttons that move, turn and scale one or more objects by exact steps along the world axes.
 * exports: createPads(choice, {id = 'object', many = ''}) -> {show({turns, scales}) -> node}
 *   choice: {name, move(by, gesture), turn(by, gesture), scale(factor, gesture)}; id: key of the stored step sizes;
 *   many: a word for the labels */

import { button, element, gestures, memory, number } from './ui.js';

const AXES = ['x', 'y', 'z'];

export function createPads(choice, { id = 'object', many = '' } = {}) {
  const steps = {
    length: memory.get(`${id}.length`, 0.1),
    angle: memory.get(`${id}.angle`, 15),
    factor: memory.get(`${id}.factor`, 1.1),
  };
  const named = (verb) => (many ? `${verb} ${many}` : verb);
  const presses = gestures('step');
  /* Consecutive presses of one button are one undo step. */
  const nameOf = (what) => presses.at(performance.now(), what);

  function pad(label, size, act) {
    return element(
      'div',
      { class: 'pad object-pad', role: 'group', 'aria-label': label },
      AXES.flatMap((axis, index) =>
        [-1, 1].map((sign) => {
          const by = () => AXES.map((_, at) => (at === index ? sign * steps[size] : 0));
          const face = `${sign < 0 ? '\u2212' : '+'}${axis}`;
          return button(face, () => act(by(), nameOf(`${choice.name} ${label} ${face}`)), {
            small: true,
            title: `${label}: ${face}`,
            'aria-label': `${label}: ${sign < 0 ? 'minus' : 'plus'} ${axis}`,
          });
        }),
      ),
    );
  }

  function sizes(label) {
    const to = (word, factor) =>
      button(word, () => choice.scale(factor(), nameOf(`${choice.name} ${label} ${word}`)), {
        small: true,
        'aria-label': `${label}: ${word.toLowerCase()}`,
      });
    return element(
      'div',
      { class: 'pad object-pad', role: 'group', 'aria-label': label },
      to('Smaller', () => 1 / steps.factor),
      to('Larger', () => steps.factor),
    );
  }

  function field(label, size, unit, max, min = 0.0001) {
    return number({
      label,
      value: steps[size],
      min,
      max,
      unit,
      onchange: (value) => {
        steps[size] = value;
        memory.set(`${id}.${size}`, value);
      },
    }).node;
  }

  return {
    show({ turns, scales }) {
      return element(
        'div',
        { class: 'object-steps' },
        field('Step', 'length', 'units', 1e6),
        pad(named('Move'), 'length', choice.move),
        turns ? [field('Angle', 'angle', '°', 360), pad(named('Turn'), 'angle', choice.turn)] : null,
        scales ? [field('Factor', 'factor', '', 1000, 1.0001), sizes(named('Scale'))] : null,
      );
    },
  };
}
