/* What the page adds to the linter's notes: a button for a remedy that sets a parameter, and, for the depth limit, why
 * it shows.
 * exports: noteAction(note) -> {label, path, value} or null
 *          noteReason(note) -> paragraphs
 *          depthNote(tree, beyond) -> {text, label, path, value}: how much of a pixel's light the depth limit cuts off,
 *          as a note and its remedy; null below 1 % */

import { digits } from './ui.js';

const DEPTH_MAX = 64;
const CUT_LEAST = 0.01;
const LABELS = { 'render.depth': 'Raise the depth' };

export function noteAction({ remedy }) {
  const set = /^set ([\w.-]+)=([\w.+-]+)/.exec(remedy || '');
  if (!set) return null;
  const [, path, text] = set;
  const value = Number.isFinite(Number(text)) ? Number(text) : text;
  return { label: `${LABELS[path] || `Set ${path}`} to ${text}`, path, value };
}

export function noteReason({ place }) {
  if (place !== 'render.depth') return [];
  return [
    'Rays end at the depth limit and have the colour of the sky there, so places seen through many surfaces, ' +
      'such as the base of a vessel and the surface of its water from below, are pale. Part of the paleness is real: ' +
      'total reflection mirrors the sky in the base at any depth.',
    'The default is 4, because a ray can split at each surface and the work can double with each level: 4 keeps an ' +
      'image fast while it is changed.',
  ];
}

export function depthNote(tree, beyond) {
  const cut = tree.rays.filter(({ node }) => node.end === 'cut_depth');
  const share = cut.reduce((sum, { weight }) => sum + weight, 0);
  const { depth } = tree.answer;
  if (share < CUT_LEAST || depth >= DEPTH_MAX) return null;
  const value = Math.min(DEPTH_MAX, Math.max(depth + 2, 2 * depth));
  const look = beyond === 'black' ? 'are black there, so the pixel is too dark' : 'have the colour of the sky there';
  return {
    text: `Rays with ${digits(100 * share, 2)} % of this pixel's weight end at the depth limit, ${depth}, and ${look}.`,
    label: `${LABELS['render.depth']} to ${value}`,
    path: 'render.depth',
    value,
  };
}
