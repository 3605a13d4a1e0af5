/* The drags of an input of type range. A drag is one gesture, and so are keys without a pause; Escape ends a drag at
 * the value before it.
 * exports:
 *   sliderDrag(input, {value(), before(), show(value), send(value, gesture), rest(value, gesture)}) -> {busy()}
 *     value: at its position; before: the exact value that is shown when a drag begins; rest: called at the end */

import { gestures } from './elements.js';
import { dragging, takeBack } from './escape.js';

export function sliderDrag(input, { value, before, show, send, rest }) {
  const presses = gestures('slider');
  let dragged = false;
  let name = null;
  let start = null;
  let cancelled = false;
  let end = null;

  /* The browser goes on with the drag until the button is released; the event change comes after that. */
  function cancel() {
    cancelled = true;
    dragged = false;
    show(start);
    if (!name) return;
    send(start, name);
    takeBack(name);
  }

  function lift() {
    end?.();
    setTimeout(() => {
      cancelled = false;
    });
  }

  input.addEventListener('pointerdown', () => {
    presses.end();
    name = null;
    const shown = before();
    start = Number.isFinite(shown) ? shown : value();
    end = dragging(cancel);
  });
  for (const each of ['pointerup', 'pointercancel']) input.addEventListener(each, lift);
  input.addEventListener('input', (event) => {
    if (cancelled) {
      show(start);
      return;
    }
    name = presses.at(event.timeStamp, '', dragged);
    dragged = true;
    const next = value();
    show(next);
    send(next, name);
  });
  input.addEventListener('change', () => {
    if (!cancelled) rest?.(value(), name ?? presses.at(performance.now()));
    dragged = false;
  });
  return { busy: () => dragged };
}
