/* Two fingers on the image, with every tool: their distance scales the camera's distance from the pivot, and their
 * centre pans.
 * exports: createPinch(stage, lab, letGo): letGo(event) ends the drag of the active tool that the first finger began */

import { moveCamera, unitsPerPixel } from './camera_moves.js';
import { gesture } from './ui.js';

const LEAST_PX = 20; /* fingers that touch each other have no useful ratio of distances */

export function createPinch(stage, lab, letGo) {
  const touches = new Map();
  let last = null; /* {x, y, spread, gesture} while two fingers are down, and until both are lifted */

  const listen = (name, act) =>
    stage.addEventListener(
      name,
      (event) => {
        if (event.pointerType === 'touch' && act(event)) event.stopPropagation();
      },
      { capture: true },
    );
  listen('pointerdown', down);
  listen('pointermove', move);
  for (const name of ['pointerup', 'pointercancel']) listen(name, lift);

  /* True for events that the tools must not see. */
  function down(event) {
    touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (touches.size < 2) return false;
    if (touches.size === 2) {
      letGo(event);
      last = { ...span(), gesture: gesture('pinch') };
      stage.setPointerCapture(event.pointerId);
    }
    return true;
  }

  function span() {
    const [a, b] = [...touches.values()];
    return {
      x: (a.x + b.x) / 2,
      y: (a.y + b.y) / 2,
      spread: Math.max(LEAST_PX, Math.hypot(a.x - b.x, a.y - b.y)),
    };
  }

  function move(event) {
    const touch = touches.get(event.pointerId);
    if (!touch || !last) return false;
    Object.assign(touch, { x: event.clientX, y: event.clientY });
    if (touches.size === 2 && lab.state?.view && lab.view.width) {
      const now = span();
      const unit = unitsPerPixel(lab, lab.state.view.distance);
      const step = [-(now.x - last.x) * unit, (now.y - last.y) * unit, 0];
      moveCamera(lab, { zoom: last.spread / now.spread, step }, last.gesture);
      Object.assign(last, now);
    }
    return true;
  }

  /* The finger that remains does not go on with the tool. */
  function lift(event) {
    const mine = Boolean(last);
    touches.delete(event.pointerId);
    if (touches.size === 0) last = null;
    return mine;
  }
}
