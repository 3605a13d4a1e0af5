/* The banner that reports a lost server, or an engine in the browser that stopped, and disables the controls meanwhile.
 * exports: createBanner(banner, parts, lab); parts become inert while it is lost */

import { element, icon, replace } from './ui.js';

const sentence = (text) => `${text[0].toUpperCase()}${text.slice(1)}.`;

const words = {
  lost: ({ kind, lost }) =>
    kind === 'server'
      ? ['The server does not answer.', 'Is cuvette lab still running? The page reconnects by itself.']
      : [lost().error, lost().remedy].map(sentence),
  refused: () => [
    "The server does not accept this page's token.",
    'The server was probably restarted: open the new address in its terminal.',
  ],
};

export function createBanner(banner, parts, lab) {
  let held = null; /* the element that had the focus and gets it back */
  const show = (how) => {
    const [what, remedy] = words[how]?.(lab.engine) || [];
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
    if (how === 'open' && before !== 'opening') lab.say('Reconnected to the server.');
    before = how;
  });
}
