/* What the page adds to the linter's notes: a button for a remedy that sets parameters, and, for the depth limit, why
 * it shows.
 * exports: noteAction(note) -> {label, values: {path: value}} or null
 *          noteReason(note) -> paragraphs
 *          depthNote(tree, lab) -> {text, label, values}: how much of a pixel's light the depth limit cuts off, as a
 *          note and its remedy; null below 1 % */

import { digits } from './ui.js';

const CUT_LEAST = 0.01;
const LABELS = { 'render.depth': 'Raise the depth' };
const WITHOUT_LIMIT = { 'render.integrator': 'path', 'render.depth': 'unlimited' };

const labelOf = (path, text) => `${LABELS[path] || `Set ${path}`} to ${text}`;

export function noteAction({ remedy }) {
  const set = /^set ([\w.-]+=[\w.+-]+(?: and [\w.-]+=[\w.+-]+)*)/.exec(remedy || '');
  if (!set) return null;
  const pairs = set[1].split(' and ').map((one) => one.split('='));
  const values = pairs.map(([path, text]) => [path, Number.isFinite(Number(text)) ? Number(text) : text]);
  const label =
    pairs.length === 1 ? labelOf(...pairs[0]) : `Set ${pairs.map(([path, text]) => `${path} to ${text}`).join(', ')}`;
  return { label, values: Object.fromEntries(values) };
}

export function noteReason({ place }) {
  if (place !== 'render.depth') return [];
  return [
    'Rays end at the depth limit, and render.beyond replaces their light: by the sky, its mean, or black. So places ' +
      'seen through many surfaces or in several mirrors have a wrong colour. The panel Compare shows where: Cut light.',
    'An image that no longer changes with the depth is not right for that: between two mirrors rays end at any depth.',
    'The default is 4, because a ray can split at each surface and the work can double with each level: 4 keeps an ' +
      'image fast while it is changed.',
  ];
}

export function depthNote(tree, lab) {
  const most = lab.param('render.depth').highest;
  const beyond = lab.param('render.beyond')?.value;
  const cut = tree.rays.filter(({ node }) => node.end === 'cut_depth');
  const share = cut.reduce((sum, { weight }) => sum + weight, 0);
  const { depth } = tree.answer;
  if (share < CUT_LEAST) return null;
  const value = Math.min(most, Math.max(depth + 2, 2 * depth));
  const look = beyond === 'black' ? 'are black there, so the pixel is too dark' : 'have the colour of the sky there';
  return {
    text: `Rays with ${digits(100 * share, 2)} % of this pixel's weight end at the depth limit, ${depth}, and ${look}.`,
    ...(depth < most
      ? { label: labelOf('render.depth', value), values: { 'render.depth': value } }
      : { label: 'Trace random paths without a limit', values: WITHOUT_LIMIT }),
  };
}
