/* Says at once that the server is gone, and keeps controls from being used meanwhile.
 * exports: createBanner(banner, parts, lab); parts become inert while there is no server */

import { element, icon, replace } from './ui.js';

const words = {
  lost: ['The server does not answer.', 'Is cuvette lab still running? The page goes on by itself when it is back.'],
  refused: [
    'This page is not known to the server.',
    'It was probably started anew: open the address that it has printed in its terminal.',
  ],
};

export function createBanner(banner, parts, lab) {
  let held = null; /* what had the focus, which goes back to it */
  const show = (how) => {
    const [what, remedy] = words[how] || [];
    banner.hidden = !what;
    document.body.classList.toggle('lost', Boolean(what));
    if (what && banner.dataset.how !== how)
      replace(banner, icon('warning'), element('strong', { text: what }), element('span', { text: remedy }));
    banner.dataset.how = what ? how : '';
    const gone = Boolean(what);
    if (gone && !parts[0].inert) held = document.activeElement;
    for (const part of parts) {
      part.inert = Boolean(what);
      part.setAttribute('aria-busy', String(Boolean(what)));
    }
    if (gone) return;
    banner.replaceChildren();
    if (document.activeElement === document.body) held?.focus?.({ preventScroll: true });
    held = null;
  };
  let before = lab.connected;
  lab.on('connection', (how) => {
    show(how);
    if (how === 'open' && before !== 'opening') lab.say('The server is back.');
    before = how;
  });
}
