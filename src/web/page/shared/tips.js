/* Tooltips for those without a mouse: the title of a control appears under it while the keyboard is on it, and while a
 * finger stays on it. With a mouse the browser shows titles, and screen readers read them. exports: createTips() */

import { element } from './ui.js';

const WAIT_MS = 600;
const GAP = 6;

export function createTips() {
  const tip = element('div', { class: 'tip', 'aria-hidden': 'true', popover: 'manual' });
  let waiting = 0;
  let held = false; /* a finger showed it: lifting it does not press the control */
  document.body.append(tip);

  const hide = () => {
    clearTimeout(waiting);
    if (tip.matches(':popover-open')) tip.hidePopover();
  };
  const soon = (target, then) => {
    hide();
    const about = target.closest?.('[title]');
    if (!about?.title || about.title === about.innerText) return;
    waiting = setTimeout(() => {
      place(tip, about);
      then?.();
    }, WAIT_MS);
  };

  document.addEventListener('focusin', ({ target }) => (target.matches(':focus-visible') ? soon(target) : hide()));
  document.addEventListener('focusout', hide);
  document.addEventListener('keydown', hide, { capture: true });
  document.addEventListener('pointerdown', ({ target, pointerType }) => {
    hide();
    held = false;
    if (pointerType === 'touch' && target.closest('button, label'))
      soon(target, () => {
        held = true;
      });
  });
  for (const name of ['pointerup', 'pointercancel']) document.addEventListener(name, hide);
  document.addEventListener(
    'click',
    (event) => {
      if (held) event.preventDefault();
      if (held) event.stopPropagation();
      held = false;
    },
    { capture: true },
  );
  document.addEventListener('contextmenu', (event) => held && event.preventDefault());
}

/* Under the control, or above it where there is no room. */
function place(tip, about) {
  if (!about.isConnected) return;
  tip.textContent = about.title;
  tip.showPopover(); /* above a dialog, too */
  const box = about.getBoundingClientRect();
  const { width, height } = tip.getBoundingClientRect();
  const below = box.bottom + GAP + height <= innerHeight;
  tip.style.left = `${Math.max(GAP, Math.min(innerWidth - width - GAP, box.left + (box.width - width) / 2))}px`;
  tip.style.top = `${below ? box.bottom + GAP : Math.max(GAP, box.top - GAP - height)}px`;
}
