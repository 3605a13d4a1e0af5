/* The English texts whose number {n} may be one. Catalogues of other languages have all their plural forms themselves.
 * exports: SINGULARS {text: its form for 1} */

export const SINGULARS = {
  '{n} notes': '{n} note',
};
