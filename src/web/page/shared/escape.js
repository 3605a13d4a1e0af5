/* Escape takes back the drag that is under way, wherever it began.
 * exports:
 *   createEscape(lab)
 *   dragging(cancel) -> end()      a drag began; Escape calls cancel(), unless end() was called before
 *   takeBack(gesture)              undoes what the changes of that gesture did, for cancel() */

let lab = null;
const running = new Set();

export function createEscape(theLab) {
  lab = theLab;
  const key = (event) => {
    if (event.key !== 'Escape' || !running.size) return;
    const cancels = [...running];
    running.clear();
    for (const { cancel } of cancels) cancel();
    lab.say('The drag is cancelled.');
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  addEventListener('keydown', key, { capture: true });
}

export function dragging(cancel) {
  const drag = { cancel };
  running.add(drag);
  return () => running.delete(drag);
}

export const takeBack = (gesture) => lab.change.takeBack(gesture).catch(lab.fail);
