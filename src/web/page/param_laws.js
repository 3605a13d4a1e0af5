/* A medium takes its index from `ior`, from a law with coefficients, or from the catalogue: which of the rows are in
 * use, and what a law begins with.
 *
 * exports:
 *   hasLaw(lab, object)                 is its medium given by coefficients
 *   whyUnused(lab, object, name)        why that parameter has no effect now; '' where it has
 *   withMedium(lab, object, medium)     {path: value} to set for that medium: a law needs coefficients at once */

const ABBE_NM = [486.1, 587.6, 656.3];
const SPREAD = 0.004; /* um^2: about that of water and crown glass */

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
    return `the medium ${medium} gives the index; one that is set here takes its place`;
  if (name === 'coefficients' && value(lab, object, name).length && !hasLaw(lab, object))
    return `the medium ${medium} is not given by coefficients`;
  return '';
}

/* Those of the scene as it was opened, where it had that law; else some that are near the index of now. */
export function withMedium(lab, object, medium) {
  const set = { [`${object}.medium`]: medium };
  if (!(medium in STARTS)) return set;
  const was = lab.param(`${object}.coefficients`)?.initial;
  const kept = lab.param(`${object}.medium`)?.initial === medium && was?.length;
  return { ...set, [`${object}.coefficients`]: kept ? was : STARTS[medium](value(lab, object, 'ior') || 1) };
}
