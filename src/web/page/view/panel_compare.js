/* The panel Compare: the reference image A and the newest image B, as images and in numbers, and maps of the cost of
 * each pixel. exports: panel */

import { say } from '../shared/language.js';
import {
  button,
  choice,
  count,
  digits,
  element,
  empty,
  facts,
  notice,
  replace,
  seconds,
  slider,
  table,
  vector,
} from '../shared/ui.js';
import { createCompareView } from './compare_view.js';
import { createCostMaps } from './cost_maps.js';

const CLOSE_UP = 12; /* CSS pixels per image pixel */
const writes = (target) =>
  target.closest?.(
    'input:not([type=range]):not([type=checkbox]):not([type=radio]), textarea, select, [contenteditable]',
  );

let model = null;

/* Requests a comparison whenever there is a reference image and a final image that is not compared yet. */
function createModel(lab) {
  const listeners = new Set();
  const mine = {
    answer: null,
    error: null,
    reference: null,
    current: false,
    on: (listener) => listeners.add(listener),
  };
  let asking = false;
  let again = false;
  const key = (reference) => (reference ? reference.serial : 0);
  lab.on('state', ({ reference }) => {
    if (key(reference) === key(mine.reference)) return;
    Object.assign(mine, { reference: reference || null, answer: null, error: null });
    ask();
  });
  lab.on('image', (image) => {
    mine.current = Boolean(mine.answer) && image.final && mine.answer.b.serial === image.serial;
    if (image.final && !mine.current) ask();
    else notify();
  });
  lab.on('restarted', () => {
    Object.assign(mine, { reference: null, answer: null, error: null });
    notify();
  });
  return mine;

  function notify() {
    for (const listener of listeners) listener(mine);
  }

  async function ask() {
    again = true;
    notify();
    if (asking) return;
    asking = true;
    while (again) {
      again = false;
      if (mine.reference && lab.image?.final) await fetchAnswer(key(mine.reference));
    }
    asking = false;
  }

  async function fetchAnswer(of) {
    try {
      const answer = await lab.get('/api/compare');
      if (key(answer.a) === of && of === key(mine.reference))
        Object.assign(mine, { answer, error: null, current: answer.b.serial === lab.image?.serial });
    } catch (error) {
      if (error.status === 409)
        mine.current = false; /* B is being rendered again, or A was cleared: an event will follow */
      else mine.error = error;
    }
    notify();
  }
}

const sameSize = ({ a, b }) => a.width === b.width && a.height === b.height;

/* How A and B are shown: the mode, its slider, and the flip key. */
function createShow(lab) {
  const view = createCompareView(lab, setFraction);
  const how = choice({
    label: 'Show',
    radios: true,
    value: 'wipe',
    choices: [
      ['b', 'B'],
      ['wipe', 'Wipe'],
      ['map', 'Difference'],
    ],
    onchange: () => draw(),
  });
  const fraction = slider({
    label: 'Fraction of A',
    min: 0,
    max: 100,
    step: 1,
    value: 50,
    unit: '%',
    oninput: (value) => setFraction(value / 100),
  });
  const strength = slider({
    label: 'Strength',
    min: 0,
    max: 100,
    step: 1,
    value: 100,
    unit: '%',
    oninput: (value) => view.set({ strength: value / 100 }),
  });
  const flip = button('Hold to see A', null, { icon: 'eye', small: true, title: 'Hold the button or the key F' });
  const legend = element('p', {
    class: 'hint',
    text: 'FLIP error: black for no difference, through purple and orange to pale yellow for large ones.',
  });
  const node = element(
    'div',
    { class: 'compare-show', hidden: true },
    how.node,
    fraction.node,
    strength.node,
    legend,
    flip,
  );
  let addresses = { a: null, map: null };

  hold(flip, view.flip);
  return { node, set, markPixel: (pixel) => view.set({ pixel }) };

  function setFraction(value) {
    fraction.set(100 * value);
    view.set({ fraction: value });
  }

  function set(next) {
    addresses = next;
    node.hidden = !next.a;
    draw();
  }

  function draw() {
    fraction.node.hidden = how.value !== 'wipe';
    strength.node.hidden = legend.hidden = how.value !== 'map';
    view.set({ ...addresses, map: how.value === 'map' ? addresses.map : null, mode: how.value });
    const named = addresses.map ? 'Difference from A' : 'Difference from A: shown when the image is finished';
    lab.view.note('compare', how.value === 'map' && addresses.a ? named : null, () => {
      how.set('b');
      draw();
      lab.view.stage.focus();
    });
  }
}

function hold(node, flip) {
  const on = (down) => (event) => {
    if (event.type.startsWith('key') && event.key !== ' ' && event.key !== 'Enter') return;
    flip(down);
    if (event.type.startsWith('key')) event.preventDefault();
  };
  for (const name of ['pointerdown', 'keydown']) node.addEventListener(name, on(true));
  for (const name of ['pointerup', 'pointercancel', 'pointerleave', 'keyup']) node.addEventListener(name, on(false));
  node.addEventListener('blur', () => flip(false));
  document.addEventListener('keydown', (event) => {
    if (event.key.toLowerCase() === 'f' && !event.ctrlKey && !event.metaKey && !event.altKey && !writes(event.target))
      flip(true);
  });
  document.addEventListener('keyup', (event) => {
    if (event.key.toLowerCase() === 'f') flip(false);
  });
  window.addEventListener('blur', () => flip(false));
}

/* Zooms in with that pixel in the centre. */
function closeUp(lab, x, y) {
  const { view } = lab;
  view.zoom(CLOSE_UP / view.scale, view.toScreen(x + 0.5, y + 0.5));
  const at = view.toScreen(x + 0.5, y + 0.5);
  view.pan(view.stage.clientWidth / 2 - at.x, view.stage.clientHeight / 2 - at.y);
  view.stage.focus();
}

function pinButtons(lab) {
  const ask = (work, done) => () =>
    work()
      .then(() => lab.say(done))
      .catch(lab.fail);
  const reference = button(
    'Pin as A',
    ask(() => lab.post('/api/reference', {}), 'Image pinned as A'),
    { icon: 'pin', kind: 'primary' },
  );
  const drop = button(
    'Clear A',
    ask(() => lab.del('/api/reference'), 'A cleared'),
    { icon: 'close', kind: 'quiet' },
  );
  return {
    node: element('div', { class: 'compare-buttons' }, reference, drop),
    show() {
      reference.disabled = !lab.image?.final;
      reference.title = reference.disabled
        ? say('available when the image is finished')
        : say('make the current image the reference A');
      drop.disabled = !model.reference;
    },
  };
}

function numbers({ a, b, comparison, changed }, goto) {
  return element(
    'div',
    { class: 'compare-numbers' },
    comparison ? null : notice(sizes(a, b), { kind: 'warning' }),
    comparison && a.film_hash === b.film_hash ? notice('The two films are bit-identical.', { kind: 'good' }) : null,
    comparison ? similarity(comparison, goto) : null,
    changes(changed),
    costs(a, b),
  );
}

/* The map of an earlier image would hide the newest one while the scene changes or a slime plays. */
function addressesOf({ reference, answer, current }) {
  if (!reference || (answer && !sameSize(answer))) return { a: null, map: null };
  const map = current && answer?.comparison ? `/api/compare.png?a=${reference.serial}&b=${answer.b.serial}` : null;
  return { a: `/api/reference.png?a=${reference.serial}`, map };
}

function create(root, lab) {
  const buttons = pinButtons(lab);
  const how = createShow(lab);
  const below = element('div', { class: 'compare-below' });
  root.append(buttons.node, how.node, below, createCostMaps(lab).node);
  const goto = (x, y) => {
    how.markPixel([x, y]);
    closeUp(lab, x, y);
  };
  let shown = null;
  const show = () => {
    buttons.show();
    how.set(addressesOf(model));
    if (model.answer && !model.error) {
      if (shown !== model.answer) {
        replace(below, numbers(model.answer, goto));
        how.markPixel(null);
      }
      below.firstChild.setAttribute('aria-busy', String(!model.current));
      below.firstChild.classList.toggle('stale', !model.current);
      shown = model.answer;
      return;
    }
    shown = null;
    how.markPixel(null);
    if (model.error) replace(below, notice(model.error.message, { kind: 'error', remedy: model.error.remedy }));
    else
      replace(
        below,
        empty(
          model.reference
            ? 'A is pinned. The comparison appears when the image is finished.'
            : 'Pin the finished image as A, then change the scene to compare.',
        ),
      );
  };
  model.on(show);
  show();
}

export const panel = {
  id: 'compare',
  title: 'Compare',
  css: 'view/panel_compare.css',
  start: (lab) => {
    model = createModel(lab);
  },
  create,
};

/* --- the numbers: tables of the reply of /api/compare --- */

const sizes = (a, b) =>
  say('A has {a} pixels, B {b}: only images of the same size can be compared.', {
    a: `${a.width} × ${a.height}`,
    b: `${b.width} × ${b.height}`,
  });

/* null means infinity: identical images have no error. */
const decibels = (value) => (value === null ? say('∞ (equal)') : `${digits(value)} dB`);

function similarity(comparison, goto) {
  const { largest, largest_at: place } = comparison;
  const where = place
    ? element(
        'span',
        { class: 'compare-largest' },
        `${say('{value} at', { value: digits(largest) })} `,
        button(`${place[0]}, ${place[1]}`, () => goto(...place), { small: true, title: 'Show this pixel' }),
      )
    : '0';
  return facts([
    ['PSNR', decibels(comparison.psnr_db)],
    ['SSIM', digits(comparison.ssim, 5)],
    ['FLIP', digits(comparison.flip)],
    ['Largest difference', where],
    ['Pixels that differ', `${digits(100 * comparison.differing_fraction)} %`],
  ]);
}

const ratio = (a, b) => (a > 0 && Number.isFinite(b) ? `× ${digits(b / a, 3)}` : '–');
const rate = ({ rays, wall_s: wall }) => (wall > 0 ? rays / wall : NaN);

function costs(a, b) {
  const line = (name, x, y, words) => [name, words(x), words(y), ratio(x, y)];
  return table({
    caption: 'Rendering cost',
    columns: ['Cost', { label: 'A', numeric: true }, { label: 'B', numeric: true }, { label: 'B / A', numeric: true }],
    rows: [
      line('Wall time', a.wall_s, b.wall_s, seconds),
      line('CPU time', a.cpu_s, b.cpu_s, seconds),
      line('Rays', a.rays, b.rays, count),
      line('Rays per second', rate(a), rate(b), count),
      line('Threads', a.threads, b.threads, count),
      ['Film', hash(a), hash(b), a.film_hash === b.film_hash ? say('the same') : say('different')],
    ],
  });
}

const hash = ({ film_hash: text }) => element('code', { class: 'film-hash', text: text || '–' });

const value = (what) =>
  what === null ? '–' : Array.isArray(what) ? vector(what) : typeof what === 'number' ? digits(what, 6) : String(what);

function changes(list) {
  if (!list.length) return element('p', { class: 'hint', text: 'Both scenes have the same parameters.' });
  return table({
    caption: 'Parameters that changed',
    columns: ['Parameter', 'A', 'B'],
    rows: list.map(({ path, a, b }) => [path, value(a), value(b)]),
  });
}
