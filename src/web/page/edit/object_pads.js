/* Buttons that move, turn and scale objects by exact steps along the world axes.
 * exports:
 *   createPads(choice, {id = 'object', many = ''}) -> {show({turns, scales}) -> node}
 *     choice: {name, move(by, gesture), turn(by, gesture), scale(factor, gesture)}; id: key of the stored step sizes;
 *     many: a word for the labels
 *   createScenePads(lab) -> node     buttons for the scene: its solids, lights, camera, or some of them; rotation and
 *                                    scaling are about the origin */

import { button, checkbox, element, gestures, group, memory, number, svg } from '../shared/ui.js';
import { add } from '../shared/vectors.js';

const AXES = ['x', 'y', 'z'];
/* What a positive angle does about each axis: the world is left-handed (cuvette-scene(5)). */
const TURNS = ['y to z', 'z to x', 'x to y'];

/* The axes as a new scene's camera sees them, and a turn about z. */
function turnSense() {
  const word = (x, y, label) => svg('text', { x, y }, label);
  return element(
    'div',
    { class: 'object-sense hint' },
    svg(
      'svg',
      { class: 'object-axes', viewBox: '0 0 72 60', role: 'img', 'aria-label': 'x right, y up, z away; x turns to y' },
      svg('path', { d: 'M12 50H56M12 50V10M12 50 34 28M40 50A28 28 0 0 0 12 22M18 18l-6 4 5 5' }),
      word(60, 54, 'x'),
      word(9, 7, 'y'),
      word(37, 27, 'z'),
    ),
    element('span', {
      text: 'Plus turns by the rule of the left hand: counter-clockwise for an eye that looks along the axis.',
    }),
  );
}

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
            title: size === 'angle' && sign > 0 ? `${label}: ${face}, ${TURNS[index]}` : `${label}: ${face}`,
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
        field('Step', 'length', 'units'),
        pad(named('Move'), 'length', choice.move),
        turns ? [field('Angle', 'angle', '°', 360), pad(named('Turn'), 'angle', choice.turn), turnSense()] : null,
        scales ? [field('Factor', 'factor', '', 1000, 1.0001), sizes(named('Scale'))] : null,
      );
    },
  };
}

const PARTS = [
  ['solids', 'Solids', true],
  ['lights', 'Lights', true],
  ['camera', 'Camera', false],
];
const join = (waiting, newer) => ({ by: add(waiting.by, newer.by) });
const product = (waiting, newer) => ({ factor: waiting.factor * newer.factor });

export function createScenePads(lab) {
  const boxes = PARTS.map(([word, label, on]) => ({ word, box: checkbox(label, on) }));
  const scene = {
    get name() {
      return boxes
        .filter(({ box }) => box.value)
        .map(({ word }) => word)
        .join('+');
    },
    move: (by, gesture) => send('move', { by }, { gesture, merge: join }),
    turn: (by, gesture) => send('turn', { by }, { gesture, merge: join }),
    scale: (factor, gesture) => send('scale', { factor }, { gesture, merge: product }),
  };
  const pads = createPads(scene, { id: 'whole', many: 'all' });
  return group(
    'Whole scene',
    { id: 'edit.whole', open: false, hint: 'move, turn and scale all together, about the origin' },
    element(
      'div',
      { class: 'buttons', role: 'group', 'aria-label': 'Parts of the scene' },
      boxes.map(({ box }) => box.node),
    ),
    pads.show({ turns: true, scales: true }),
  );

  /* If only the camera is selected, it turns in place and cannot be scaled. */
  function send(what, body, how) {
    if (!scene.name) return lab.say('Select solids, lights or the camera first.');
    return lab.change(`/api/objects/${encodeURIComponent(scene.name)}/${what}`, body, how).catch(lab.fail);
  }
}
