/* Steps for the whole scene: its solids, lights, camera, or some of them. Rotation and scaling are about the origin.
 * exports: createWhole(lab) -> node */

import { check, element, group } from './ui.js';
import { add } from './ray_vectors.js';
import { createPads } from './object_pads.js';

const PARTS = [
  ['solids', 'Solids', true],
  ['lights', 'Lights', true],
  ['camera', 'Camera', false],
];
const join = (waiting, newer) => ({ by: add(waiting.by, newer.by) });
const product = (waiting, newer) => ({ factor: waiting.factor * newer.factor });

export function createWhole(lab) {
  const boxes = PARTS.map(([word, label, on]) => ({ word, box: check(label, on) }));
  const whole = {
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
  const pads = createPads(whole, { id: 'whole', many: 'all' });
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

  /* The camera alone turns in place and cannot be scaled. */
  function send(what, body, how) {
    if (!whole.name) return lab.say('Select solids, lights or the camera first.');
    return lab.change(`/api/objects/${encodeURIComponent(whole.name)}/${what}`, body, how).catch(lab.fail);
  }
}
