/* The status line: properties and cost of the displayed image, the last message, and the live region for screen
 * readers; and the banner that reports a lost server, or an engine in the browser that stopped.
 * exports:
 *   createStatus(root, live, lab)       sets lab.say(words, remedy, {label, act} of a button, {brief, dismissed}),
 *                                       which returns a function that withdraws the message, and lab.fail(error).
 *                                       brief: in one line, also on a telephone; dismissed(): the user closed the
 *                                       message
 *   createBanner(banner, parts, lab)    the parts become inert while the engine is lost */

import { say, translated } from './shared/language.js';
import { located } from './shared/api.js';
import { button, copy, count, digits, element, icon, replace, seconds } from './shared/ui.js';

/* --- the banner --- */

const sentence = (text) => `${text[0].toUpperCase()}${text.slice(1)}.`;

const words = {
  lost: ({ kind, lost }) =>
    kind === 'server'
      ? ['The server does not answer.', 'Is cuvette lab still running? The page reconnects by itself.']
      : [lost().error, lost().remedy].map(translated).map(sentence),
  refused: () => [
    "The server does not accept this page's token.",
    'The server was probably restarted: open the new address in its terminal.',
  ],
};

export function createBanner(banner, parts, lab) {
  let focused = null; /* the element that had the focus and gets it back */
  const show = (how) => {
    const [what, remedy] = words[how]?.(lab.engine) || [];
    banner.hidden = !what;
    document.body.classList.toggle('lost', Boolean(what));
    if (what && banner.dataset.how !== how)
      replace(banner, icon('warning'), element('strong', { text: what }), element('span', { text: remedy }));
    banner.dataset.how = what ? how : '';
    const gone = Boolean(what);
    if (gone && !parts[0].inert) focused = document.activeElement;
    for (const part of parts) {
      part.inert = Boolean(what);
      part.setAttribute('aria-busy', String(Boolean(what)));
    }
    if (gone) return;
    banner.replaceChildren();
    if (document.activeElement === document.body) focused?.focus?.({ preventScroll: true });
    focused = null;
  };
  let before = lab.connected;
  lab.on('connection', (how) => {
    show(how);
    if (how === 'open' && before !== 'opening') lab.say('Reconnected to the server.');
    before = how;
  });
}

/* --- the status line --- */

const LINGER_MS = 6000;
const CUT_SHOWN = 0.01; /* fraction of the light of a mean pixel */
const REDRAW_MS = 200; /* numbers that change faster cannot be read, and drawing them delays the images */

export function createStatus(root, live, lab) {
  const facts = element('div', { class: 'status-facts' });
  const message = element('div', { class: 'status-message', hidden: true });
  let timer = 0;
  let due = 0;
  let drawnAt = -Infinity;
  root.append(facts, message);

  const clear = () => {
    message.hidden = true;
    message.replaceChildren();
  };

  function showMessage(given, kind, givenRemedy, action, { brief = false, dismissed } = {}) {
    const [words, remedy] = [given, givenRemedy].map(translated);
    const dismiss = () => {
      clear();
      dismissed?.();
    };
    clearTimeout(timer);
    replace(
      message,
      icon(kind === 'error' ? 'warning' : 'info'),
      element(
        'span',
        { class: 'status-words', title: [words, remedy].filter(Boolean).join('. ') },
        element('strong', { text: words }),
        remedy ? ` – ${remedy}` : null,
      ),
      action ? element('span', { class: 'status-action' }, button(action.label, action.act, { small: true })) : null,
      button('Dismiss', dismiss, { icon: 'close', bare: true, kind: 'quiet', small: true }),
    );
    message.className = `status-message ${kind}${brief ? ' brief' : ''}`;
    message.hidden = false;
    live.textContent = '';
    requestAnimationFrame(() => {
      live.textContent = [words, remedy].filter(Boolean).join('. ');
    });
    timer = setTimeout(clear, kind === 'error' ? 3 * LINGER_MS : LINGER_MS);
    const mine = timer;
    return () => mine === timer && clear();
  }
  lab.say = (words, remedy, action, how) => showMessage(words, 'info', remedy, action, how);
  lab.fail = (error) => {
    if (error.status === 0 || error.status === 401) return;
    if (!error.status) console.error(error);
    showMessage(located(error), 'error', error.remedy);
  };

  const draw = () => {
    due = 0;
    drawnAt = performance.now();
    replace(facts, items(lab));
  };
  const soon = () => {
    const wait = lab.image?.final ? 0 : Math.max(0, drawnAt + REDRAW_MS - performance.now());
    if (!wait) clearTimeout(due);
    if (!wait || !due) due = setTimeout(draw, wait);
  };
  for (const name of ['image', 'state', 'connection', 'pass', 'notes']) lab.on(name, soon);
  draw();
}

const fact = (name, value, title) =>
  element(
    'span',
    { class: 'fact', title },
    element('span', { class: 'fact-name', text: name }),
    element('span', { class: 'fact-value' }, value),
  );

function items(lab) {
  const noted = lab.notes?.count() || 0;
  const { image, state } = lab;
  if (!image)
    return [element('span', { class: 'fact', text: lab.connected === 'open' ? 'No image yet' : waiting(lab.engine) })];
  const { rays, wall_s: wall } = image;
  const behind = lab.newestGeneration > image.generation || !image.final;
  return [
    element('span', {
      class: behind ? 'lamp busy' : 'lamp',
      role: 'img',
      'aria-label': behind ? 'rendering' : 'final',
      title: behind ? 'rendering' : 'final image',
    }),
    noted ? notesButton(noted, lab) : null,
    fact(
      'pass',
      image.passes ? say('{pass} of {passes}', { pass: image.pass, passes: image.passes }) : String(image.pass),
    ),
    fact(
      'size',
      image.width === image.full_width
        ? `${image.full_width} × ${image.full_height}`
        : say('{width} × {height} of {full_width} × {full_height}', image),
    ),
    time(lab.engine, wall),
    fact('rays', count(rays)),
    rays && wall ? fact('rays/s', count(rays / wall)) : null,
    image.cut >= CUT_SHOWN
      ? fact('cut light', `${digits(100 * image.cut, 2)} %`, 'by weight: rays that render.depth or min_weight cut')
      : null,
    Number.isFinite(image.noise)
      ? fact('noise', digits(image.noise, 3), 'standard error of the path-traced image')
      : null,
    image.film_hash ? fact('film', hash(image.film_hash, lab), 'hash of the film; click to copy') : null,
    fact(
      'generation',
      String(image.generation),
      state && state.generation > image.generation ? say('the scene is at generation {generation}', state) : null,
    ),
  ];
}

const waiting = ({ kind }) => (kind === 'server' ? 'Connecting …' : 'Starting the laboratory …');

/* A browser's clock is coarse, and its code differs from the program's, so its times are useless for studies. */
const time = ({ kind }, wall) =>
  kind === 'server'
    ? fact('time', seconds(wall), 'wall time of the pass')
    : fact('time in this browser', seconds(wall), 'wall time of the pass; not comparable with rows of studies');

const notesButton = (noted, lab) =>
  element(
    'button',
    {
      type: 'button',
      class: 'fact notes-button',
      title: "show the linter's notes on the scene",
      onclick: () => lab.notes.show(),
    },
    icon('warning'),
    element('span', { text: say('{n} notes', { n: noted }) }),
  );

const hash = (words, lab) =>
  element(
    'button',
    {
      type: 'button',
      class: 'hash',
      translate: 'no',
      'aria-label': say('copy film hash {hash}', { hash: words }),
      onclick: () => copy(words).then(() => lab.say('The film hash is on the clipboard.'), lab.fail),
    },
    words,
  );
