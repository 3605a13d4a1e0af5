/* The English texts whose number {n} may be one. Catalogues of other languages have all their plural forms themselves.
 * exports: SINGULARS {text: its form for 1} */

export const SINGULARS = {
  '{n} notes': '{n} note',
  '{n} cells': '{n} cell',
  '{axis}: {n} values': '{axis}: {n} value',
  '{n} rays': '{n} ray',
  '{n} cells have different films: the rendered images differ.':
    '{n} cell has different films: the rendered images differ.',
  'and {n} more media': 'and {n} more medium',
};
