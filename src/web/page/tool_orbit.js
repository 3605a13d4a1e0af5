/* The tool Orbit: dragging orbits about the target, with Shift turns in place; the wheel moves forward and back.
 * exports: orbitTool(lab), moveCamera(lab, body, gesture): sends deltas to /api/camera; waiting deltas of one
 * gesture are added */

import { gesture } from './ui.js';

const DEGREES = 0.35; /* per CSS pixel of dragging */
const WHEEL = 0.0012; /* share of the distance per CSS pixel of the wheel */
const PAUSE_MS = 400;

const sum = (a, b) => (a && b ? a.map((value, index) => value + b[index]) : a || b);

function join(waiting, newer) {
  const joined = {};
  for (const key of ['orbit', 'turn', 'step']) {
    const both = sum(waiting[key], newer[key]);
    if (both) joined[key] = both;
  }
  return joined;
}

export const moveCamera = (lab, body, name) =>
  lab.change('/api/camera', body, { gesture: name, merge: join }).catch(lab.fail);

export function orbitTool(lab) {
  let drag = null;
  let wheeling = null;
  lab.view.tool('orbit', {
    label: 'Orbit',
    icon: 'orbit',
    order: 10,
    cursor: 'grab',
    hint: 'Drag to orbit about the target; with Shift: turn in place; wheel: forward and back',
    down(point, event) {
      drag = { x: event.clientX, y: event.clientY, gesture: gesture('orbit'), turning: event.shiftKey };
      lab.view.stage.style.cursor = 'grabbing';
    },
    move(point, event) {
      const by = [(event.clientX - drag.x) * DEGREES, (event.clientY - drag.y) * DEGREES];
      Object.assign(drag, { x: event.clientX, y: event.clientY });
      if (!by[0] && !by[1]) return;
      moveCamera(lab, drag.turning ? { turn: [-by[0], by[1]] } : { orbit: by }, drag.gesture);
    },
    up() {
      drag = null;
      lab.view.stage.style.cursor = 'grab';
    },
    wheel(point, event, lines) {
      if (!wheeling || event.timeStamp - wheeling.at > PAUSE_MS) wheeling = { gesture: gesture('wheel') };
      wheeling.at = event.timeStamp;
      const distance = lab.state?.camera?.distance || 1;
      moveCamera(lab, { step: [0, 0, -lines * WHEEL * distance] }, wheeling.gesture);
    },
  });
}
