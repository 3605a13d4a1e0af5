/* Two fingers on the image, with every tool: their distance scales the camera's distance from the pivot, and their
 * centre pans.
 * exports: createPinch(stage, lab, letGo): letGo(event) ends the drag of the active tool that the first finger began */

import { moveCamera, unitsPerPixel } from './camera_moves.js';
import { gesture } from './ui.js';

const LEAST_PX = 20; /* fingers that touch each other have no useful ratio of distances */

export function createPinch(stage, lab, letGo) {
  const touches = new Map();
  /* While two fingers are down, and until both are lifted: where they began, and what is sent already. One finger moves
   * after the other, so the pan is that of the whole gesture at its present distance: a distance in between, or one
   * that the server has not reached yet, would shift the image. */
  let pinch = null; /* {x, y, spread, distance; sent: {spread, right, up}; gesture} */

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
      begin();
      stage.setPointerCapture(event.pointerId);
    }
    return true;
  }

  function begin() {
    const first = span();
    const sent = { spread: first.spread, right: 0, up: 0 };
    pinch = { ...first, distance: lab.state?.view?.distance, sent, gesture: gesture('pinch') };
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
    if (!touch || !pinch) return false;
    Object.assign(touch, { x: event.clientX, y: event.clientY });
    if (touches.size === 2 && pinch.distance && lab.view.width) send(span());
    return true;
  }

  function send(now) {
    const { sent } = pinch;
    const unit = unitsPerPixel(lab, (pinch.distance * pinch.spread) / now.spread);
    const right = -(now.x - pinch.x) * unit;
    const up = (now.y - pinch.y) * unit;
    moveCamera(lab, { zoom: sent.spread / now.spread, step: [right - sent.right, up - sent.up, 0] }, pinch.gesture);
    pinch.sent = { spread: now.spread, right, up };
  }

  /* The finger that remains does not go on with the tool. */
  function lift(event) {
    const mine = Boolean(pinch);
    touches.delete(event.pointerId);
    if (touches.size === 0) pinch = null;
    return mine;
  }
}
