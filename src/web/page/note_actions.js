/* What the page adds to the linter's notes: a button for a remedy that sets a parameter, and, for the depth limit, why
 * it shows.
 * exports: noteAction(note) -> {label, path, value} or null
 *          noteReason(note) -> paragraphs */

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
