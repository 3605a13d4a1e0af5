/* The tool Grab: drags the slime in the image with any number of pointers, or with the keyboard.
 * exports: createGrab(lab) */

import { svg } from './ui.js';
import { createHands } from './slime_hands.js';

const KEYS = 'keys';
const STEP = 0.02; /* share of the image width per key press */
const DEEP = 0.0015; /* share of the viewing distance per CSS pixel of the wheel */
const DEEP_KEY = 0.04; /* share of the viewing distance per key press */

export function createGrab(lab) {
  const { view } = lab;
  const marks = view.layer('grab');
  const hands = createHands(lab, draw);
  let cross = null; /* the keyboard's cross, in image pixels */
  const tool = {
    label: 'Grab',
    icon: 'hand',
    order: 30,
    cursor: 'grab',
    hint:
      'Drag the slime; wheel while dragging: along the view. Keys: arrows, Enter to grab and ' +
      'release, Page Up and Page Down along the view',
    chosen: () => lab.panels?.use('slime'),
    dropped() {
      hands.dropAll();
      cross = null;
      draw();
    },
    down,
    hover,
    wheel,
    key,
  };
  view.tool('grab', tool);
  tool.segment.hidden = true;
  for (const name of ['pointerup', 'pointercancel', 'lostpointercapture'])
    view.stage.addEventListener(name, (event) => hands.drop(event.pointerId));
  view.stage.addEventListener('blur', () => {
    hands.drop(KEYS);
    cross = null;
    draw();
  });
  lab.on('view', draw);
  lab.on('state', (state) => {
    tool.segment.hidden = !state.slime;
    if (!state.slime && view.chosen === 'grab') view.use('orbit');
    draw();
  });

  /* Captures each pointer itself, because the toolbar supports only one drag at a time. */
  function down(point, event) {
    if (!point.inside) return false;
    view.stage.setPointerCapture(event.pointerId);
    cross = null;
    hands.take(event.pointerId, point.x, point.y);
    event.preventDefault();
    return false;
  }

  function hover(point, event) {
    hands.get(event.pointerId)?.move(point.x, point.y);
  }

  function distance() {
    return lab.state?.camera?.distance || 1;
  }

  function push(hand, by) {
    hand.move(hand.x, hand.y, hand.depth + by * distance());
  }

  function wheel(point, event, lines) {
    const held = hands.all();
    if (!held.length) lab.say('Grab the slime first: the wheel then pulls it along the view');
    for (const hand of held) push(hand, -lines * DEEP);
  }

  function key(event) {
    const far = (event.shiftKey ? 0.2 : 1) * STEP * view.width;
    const offset = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] }[event.key];
    const deep = { PageUp: DEEP_KEY, PageDown: -DEEP_KEY }[event.key];
    const hand = hands.get(KEYS);
    if (offset) step(hand, offset);
    else if (deep && hand) push(hand, deep);
    else if (event.key === 'Enter') toggle(hand);
    else if (event.key === 'Escape' && hand) hands.drop(KEYS);
    else return false;
    draw();
    return true;
  }

  function step(hand, [dx, dy]) {
    cross ??= { x: view.width / 2, y: view.height / 2 };
    cross = { x: Math.min(view.width, Math.max(0, cross.x + dx)), y: Math.min(view.height, Math.max(0, cross.y + dy)) };
    hand?.move(cross.x, cross.y);
  }

  function toggle(hand) {
    cross ??= { x: view.width / 2, y: view.height / 2 };
    if (hand) hands.drop(KEYS);
    else hands.take(KEYS, cross.x, cross.y);
    lab.say(hand ? 'Slime released' : 'Slime grabbed');
  }

  /* Draws it twice, a dark edge under a bright line, to be visible on any image. */
  function both(tag, attributes) {
    return [svg(tag, { ...attributes, class: 'grab-edge' }), svg(tag, { ...attributes, class: 'grab-mark' })];
  }

  function draw() {
    const px = 1 / (view.scale || 1);
    const shapes = [];
    for (const hand of hands.all()) {
      const from = hand.where && view.project(hand.where);
      if (from)
        shapes.push(
          ...both('line', { x1: from.x, y1: from.y, x2: hand.x, y2: hand.y }),
          ...both('circle', { cx: from.x, cy: from.y, r: 3 * px }),
        );
      shapes.push(...both('circle', { cx: hand.x, cy: hand.y, r: 9 * px }));
    }
    if (cross) {
      const { x, y } = cross;
      shapes.push(
        ...both('path', {
          d:
            `M${x - 16 * px} ${y}h${11 * px}m${10 * px} 0h${11 * px}M${x} ${y - 16 * px}v${11 * px}m0 ` +
            `${10 * px}v${11 * px}`,
        }),
      );
    }
    marks.replaceChildren(...shapes);
  }
}
