/* The tool Grab: drags the slime in the image with any number of pointers, or with the keyboard.
 * exports: createGrab(lab) */

import { dragging } from '../shared/escape.js';
import { svg } from '../shared/ui.js';

const KEYS = 'keys';
const STEP = 0.02; /* fraction of the image width per key press */
const DEEP = 0.0015; /* fraction of the viewing distance per CSS pixel of the wheel */
const DEEP_KEY = 0.04; /* fraction of the viewing distance per key press */

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
      'Pull the slime: drag it, and turn the wheel meanwhile for nearer and farther ' +
      '(Enter: grab and let go; arrow keys; Page Up, Page Down)',
    chosen: () => lab.panels?.select('slime'),
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
    hands.grab(event.pointerId, point.x, point.y);
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
    if (hand) {
      hands.drop(KEYS);
      lab.say('Slime released');
    } else hands.grab(KEYS, cross.x, cross.y, () => lab.say('Slime grabbed'));
  }

  /* A dark edge under a bright line is visible on any image. */
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

/* --- hands that hold the slime, one per pointer or key ---
 * Moves are sent one after the other; the newest replaces a waiting one. Positions are in pixels of the full image. A
 * hand is {x, y, depth, where ([x,y,z] of the grab point, null before), move(x, y, depth)}; changed() is called when a
 * hand is added, moved or removed, and grabbed() of a hand when it holds the slime. */

/* Errors that the user cannot avoid: the slime restarted, or the page is being closed. */
const gone = (error) => error.status === 409 || error.status === 404 || error.status === 0 || error.status === 401;

async function playing(lab) {
  if (!lab.slime?.on) await lab.post('/api/slime', { do: 'play' });
}

function createHands(lab, changed) {
  const hands = new Map();

  addEventListener('pagehide', () => {
    for (const hand of hands.values()) hand.leave();
  });
  return { all: () => [...hands.values()], grab, get: (key) => hands.get(key), drop, dropAll };

  function grab(key, x, y, grabbed) {
    drop(key);
    const hand = { x, y, depth: 0, where: null, number: null, held: true, dirty: false, sending: true };
    hand.move = (nextX, nextY, depth) => {
      Object.assign(hand, { x: nextX, y: nextY, depth: depth ?? hand.depth, dirty: true });
      changed();
      send(hand);
    };
    /* A page that is being closed cannot wait for a reply. */
    hand.leave = () => {
      if (hand.number !== null) {
        lab.engine
          .fetch('/api/slime/release', {
            method: 'POST',
            keepalive: true,
            headers: { 'Content-Type': 'application/json' },
            body: JSON.stringify({ hand: hand.number }),
          })
          .catch(() => undefined);
      }
    };
    if (key !== KEYS) hand.end = dragging(() => drop(key)); /* the slime then returns by itself */
    hands.set(key, hand);
    changed();
    hold(key, hand, x, y, grabbed);
    return hand;
  }

  async function hold(key, hand, x, y, grabbed) {
    try {
      await playing(lab);
      const reply = await lab.post('/api/slime/grab', { x, y });
      hand.number = reply.hand;
      hand.where = reply.where;
      changed();
    } catch (error) {
      forget(key, hand);
      if (error.status === 404) lab.say('No slime at that point');
      else lab.fail(error);
      return;
    }
    hand.sending = false;
    if (hand.held) {
      grabbed?.();
      send(hand);
    } else release(hand);
  }

  async function send(hand) {
    if (hand.sending) return;
    hand.sending = true;
    try {
      while (hand.dirty && hand.held) {
        hand.dirty = false;
        await lab.post('/api/slime/move', { hand: hand.number, x: hand.x, y: hand.y, depth: hand.depth });
      }
    } catch (error) {
      for (const [key, one] of hands) if (one === hand) forget(key, hand);
      if (!gone(error)) lab.fail(error);
      return;
    }
    hand.sending = false;
    if (!hand.held) release(hand);
  }

  function forget(key, hand) {
    hand.held = false;
    hand.end?.();
    if (hands.get(key) === hand) hands.delete(key);
    changed();
  }

  function release(hand) {
    if (hand.number === null) return;
    const { number } = hand;
    hand.number = null;
    lab.post('/api/slime/release', { hand: number }).catch((error) => {
      if (!gone(error)) lab.fail(error);
    });
  }

  function drop(key) {
    const hand = hands.get(key);
    if (!hand) return;
    forget(key, hand);
    if (!hand.sending) release(hand);
  }

  function dropAll() {
    for (const key of [...hands.keys()]) drop(key);
  }
}
