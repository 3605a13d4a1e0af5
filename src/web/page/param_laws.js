/* A medium takes its refractive index from `ior`, from a dispersion law with coefficients, or from the catalogue:
 * this file decides which rows are in use, and the initial coefficients of a law.
 *
 * exports:
 *   hasLaw(lab, object)                 whether its medium is given by coefficients
 *   whyUnused(lab, object, name)        why that parameter has no effect now; '' if it has one
 *   withMedium(lab, object, medium)     {path: value} to set for that medium: a law requires coefficients */

const ABBE_NM = [486.1, 587.6, 656.3]; /* the lines F, d and C of the Abbe number */
const SPREAD = 0.004; /* um^2: close to that of water and crown glass */

const round = (x) => Number(x.toPrecision(6));
const cauchy = (n, nm) => round(n + SPREAD * ((1000 / nm) ** 2 - (1000 / ABBE_NM[1]) ** 2));

const STARTS = {
  cauchy: (n) => [round(n - SPREAD * (1000 / ABBE_NM[1]) ** 2), SPREAD],
  sellmeier: () => [1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653] /* N-BK7 */,
  table: (n) => ABBE_NM.flatMap((nm) => [nm, cauchy(n, nm)]),
};

const value = (lab, object, name) => lab.param(`${object}.${name}`)?.value;

export const hasLaw = (lab, object) => value(lab, object, 'medium') in STARTS;

export function whyUnused(lab, object, name) {
  const medium = value(lab, object, 'medium');
  if (!medium) return '';
  if (name === 'ior' && medium !== 'ior')
    return `the index comes from the medium ${medium}; a value set here replaces it`;
  if (name === 'coefficients' && value(lab, object, name).length && !hasLaw(lab, object))
    return `the medium ${medium} uses no coefficients`;
  return '';
}

/* The coefficients of the opened scene if it had that law; otherwise ones close to the current index. */
export function withMedium(lab, object, medium) {
  const set = { [`${object}.medium`]: medium };
  if (!(medium in STARTS)) return set;
  const was = lab.param(`${object}.coefficients`)?.initial;
  const kept = lab.param(`${object}.medium`)?.initial === medium && was?.length;
  return { ...set, [`${object}.coefficients`]: kept ? was : STARTS[medium](value(lab, object, 'ior') || 1) };
}
