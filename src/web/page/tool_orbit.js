/* The tool Orbit: dragging orbits about the pivot, with Shift pans, with Ctrl turns in place; the wheel scales the
 * distance from the pivot, which stays.
 * exports: orbitTool(lab) */

import { createWheelZoom, moveCamera, panCamera } from './camera_moves.js';
import { gesture } from './ui.js';

const DEGREES = 0.35; /* per CSS pixel of dragging */

export function orbitTool(lab) {
  let drag = null;

  lab.view.tool('orbit', {
    label: 'Orbit',
    icon: 'orbit',
    order: 10,
    cursor: 'grab',
    hint: 'Drag to orbit about the pivot; with Shift: pan; with Ctrl: turn in place; wheel: nearer and farther',
    down(point, event) {
      const what = event.shiftKey ? 'pan' : event.ctrlKey || event.metaKey ? 'turn' : 'orbit';
      drag = { x: event.clientX, y: event.clientY, gesture: gesture(what), what };
      lab.view.stage.style.cursor = 'grabbing';
    },
    move(point, event) {
      if (!drag) return;
      const by = [event.clientX - drag.x, event.clientY - drag.y];
      Object.assign(drag, { x: event.clientX, y: event.clientY });
      if (!by[0] && !by[1]) return;
      const [right, down] = by.map((pixels) => pixels * DEGREES);
      if (drag.what === 'pan') panCamera(lab, ...by, drag.gesture);
      else moveCamera(lab, drag.what === 'turn' ? { turn: [-right, down] } : { orbit: [right, down] }, drag.gesture);
    },
    up() {
      drag = null;
      lab.view.stage.style.cursor = 'grab';
    },
    wheel: createWheelZoom(lab),
  });
}
