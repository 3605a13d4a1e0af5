/* A result that was computed from the scene: when a change makes it old, it is marked, and computed again: at once when
 * the scene rests if it is seen and was quick to compute; otherwise by a button.
 *
 * exports: createRenewal(lab, result, act) -> {node, run(), changed(), old}
 *   result: the element that holds the result; act() -> promise of whether there is a result now
 *   node: the line to put above the result; run(): computes it; changed(): the question has changed */

import { button, element } from './ui.js';

const QUICK_MS = 500;
const REST_MS = 200; /* after the last change */

export function createRenewal(lab, result, act) {
  const renew = button('Renew', () => run(), { small: true });
  const node = element(
    'p',
    { class: 'stale-bar', role: 'status', hidden: true },
    element('span', { text: 'From an earlier state of the scene.' }),
    ' ',
    renew,
  );
  let of = null; /* the version of the scene */
  let asked = 0; /* counts changes of the question */
  let answered = 0;
  let cost = Infinity;
  let busy = false;
  let timer = 0;

  const renewal = {
    node,
    run,
    get old() {
      return of !== null && (of !== lab.scene?.version || answered !== asked);
    },
    changed() {
      asked++;
      check();
    },
  };
  for (const name of ['scene', 'panel']) lab.on(name, check);
  lab.on('restarted', () => {
    if (of !== null) of = -1;
  });
  new IntersectionObserver(check).observe(result);
  return renewal;

  function check() {
    clearTimeout(timer);
    node.hidden = !renewal.old || busy;
    result.classList.toggle('stale', renewal.old);
    if (renewal.old && !busy && cost <= QUICK_MS && result.getClientRects().length) timer = setTimeout(rest, REST_MS);
  }

  function rest() {
    if (lab.dragging()) check();
    else run();
  }

  async function run() {
    if (busy) return;
    busy = true;
    renew.disabled = true;
    const [version, question, began] = [lab.scene?.version ?? null, asked, performance.now()];
    const there = await act();
    cost = performance.now() - began;
    of = there ? version : null;
    answered = question;
    busy = false;
    renew.disabled = false;
    check();
  }
}
