/* The search for parameters by words of their path, their description or everyday language.
 * exports: findParams(rows, text, near) -> rows, first those with parts of the path that begin with the words, then
 *   those whose path has their meanings; of each the paths of the set near first */

import { meaningsOf } from './param_synonyms.js';

/* What a search looks in: for a choice also its words, such as the names of media. */
const hayOf = (row) =>
  `${row.path} ${row.path.replaceAll('_', ' ')} ${row.meaning} ${(row.choices || []).join(' ')}`.toLowerCase();

export function findParams(rows, text, near = new Set()) {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  const meant = words.map(meaningsOf);
  const fits = (hay) => meant.every((some) => some.some((word) => hay.includes(word)));
  const rank = (row) => {
    const path = row.path.toLowerCase();
    const begins = (word) => path.startsWith(word) || path.split(/[._]/).some((part) => part.startsWith(word));
    const place = words.every(begins) ? 0 : fits(path) ? 2 : 4;
    return place + (near.has(row.path) ? 0 : 1);
  };
  const found = rows.filter((row) => fits(hayOf(row)));
  return [0, 1, 2, 3, 4, 5].flatMap((each) => found.filter((row) => rank(row) === each));
}
