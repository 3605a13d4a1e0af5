/* Tables of the reply of /api/compare.
 * exports: similarity(comparison, goto(x, y)), costs(a, b), changes(list), sizes(a, b) -> elements */

import { button, count, digits, element, facts, seconds, table, vector } from './ui.js';

export const sizes = (a, b) =>
  `A has ${a.width} × ${a.height} pixels, B ${b.width} × ${b.height}: only images of the same ` +
  `size can be compared.`;

/* null means infinity: identical images have no error. */
const decibels = (value) => (value === null ? '∞ (equal)' : `${digits(value)} dB`);

export function similarity(comparison, goto) {
  const { largest, largest_at: place } = comparison;
  const where = place
    ? element(
        'span',
        { class: 'compare-largest' },
        `${digits(largest)} at `,
        button(`${place[0]}, ${place[1]}`, () => goto(...place), { small: true, title: 'Show this pixel' }),
      )
    : '0';
  return facts([
    ['PSNR', decibels(comparison.psnr_db)],
    ['SSIM', digits(comparison.ssim, 5)],
    ['FLIP', digits(comparison.flip)],
    ['Largest difference', where],
    ['Pixels that differ', `${digits(100 * comparison.differing_share)} %`],
  ]);
}

const ratio = (a, b) => (a > 0 && Number.isFinite(b) ? `× ${digits(b / a, 3)}` : '–');
const rate = ({ rays, wall_s: wall }) => (wall > 0 ? rays / wall : NaN);

export function costs(a, b) {
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
      ['Film', hash(a), hash(b), a.film_hash === b.film_hash ? 'the same' : 'different'],
    ],
  });
}

const hash = ({ film_hash: text }) => element('code', { class: 'film-hash', text: text || '–' });

const value = (what) =>
  what === null ? '–' : Array.isArray(what) ? vector(what) : typeof what === 'number' ? digits(what, 6) : String(what);

export function changes(list) {
  if (!list.length) return element('p', { class: 'hint', text: 'Both scenes have the same parameters.' });
  return table({
    caption: 'Parameters that changed',
    columns: ['Parameter', 'A', 'B'],
    rows: list.map(({ path, a, b }) => [path, value(a), value(b)]),
  });
}
