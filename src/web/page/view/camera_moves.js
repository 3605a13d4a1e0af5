/* Moves of the camera, which are views of the scene: they make no undo step and leave the scene saved.
 * exports:
 *   moveCamera(lab, body, gesture)      sends {orbit, turn, step, zoom, look, frame} to /api/camera; waiting moves of
 *                                       one gesture are merged
 *   panCamera(lab, dx, dy, gesture)     the image follows a pointer by that many CSS pixels at the pivot's depth
 *   unitsPerPixel(lab, depth)           scene units per CSS pixel at a depth
 *   createWheelZoom(lab)                a tool's function wheel(point, event, pixels): scales the distance
 *   goView(lab, what)                   'back', 'forward', 'home' or 'keep'
 *   orbitTool(lab)                      the tool Orbit: dragging orbits about the pivot, with Shift pans, with Ctrl
 *                                       turns in place; the wheel scales the distance from the pivot, which stays */

import { takeBack } from '../shared/escape.js';
import { gesture, gestures } from '../shared/ui.js';
import { spreadAt } from '../shared/vectors.js';

const WHEEL = 0.0012; /* logarithm of the distance per CSS pixel of the wheel: 12 % per notch */
const PAUSE_MS = 400;

const sum = (a, b) => (a && b ? a.map((value, index) => value + b[index]) : a || b);

function join(waiting, newer) {
  const joined = { ...waiting, ...newer };
  for (const key of ['orbit', 'turn', 'step']) {
    const both = sum(waiting[key], newer[key]);
    if (both) joined[key] = both;
  }
  if (waiting.zoom && newer.zoom) joined.zoom = waiting.zoom * newer.zoom;
  return joined;
}

export const moveCamera = (lab, body, name) =>
  lab.change('/api/camera', body, { gesture: name, merge: join }).catch(lab.fail);

export function unitsPerPixel(lab, depth) {
  const { view } = lab;
  const { camera } = lab.state;
  return (2 * camera.half_width * spreadAt(camera, depth)) / (view.width * view.scale);
}

export function panCamera(lab, dx, dy, name) {
  if (!lab.state?.view || !lab.view.width || (!dx && !dy)) return;
  const unit = unitsPerPixel(lab, lab.state.view.distance);
  moveCamera(lab, { step: [-dx * unit, dy * unit, 0] }, name);
}

export function createWheelZoom(lab) {
  const turns = gestures('wheel', PAUSE_MS);
  return (point, event, pixels) => moveCamera(lab, { zoom: Math.exp(pixels * WHEEL) }, turns.at(event.timeStamp));
}

export const goView = (lab, what) => lab.change('/api/view', { do: what }).catch(lab.fail);

const DEGREES = 0.35; /* per CSS pixel of dragging */

export function orbitTool(lab) {
  let drag = null;
  const up = () => {
    drag = null;
    lab.view.stage.style.cursor = 'grab';
  };

  lab.view.tool('orbit', {
    label: 'Orbit',
    icon: 'orbit',
    order: 10,
    cursor: 'grab',
    hint: 'Walk around the scene: drag, or use the arrow keys. Shift: slide; Ctrl: look around; wheel: nearer, farther',
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
    up,
    cancel() {
      takeBack(drag.gesture);
      up();
    },
    wheel: createWheelZoom(lab),
  });
}
