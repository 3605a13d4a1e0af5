/* A medium takes its refractive index from `ior`, from a dispersion law with coefficients, or from the catalogue:
 * this file decides which rows are in use, and which coefficients a law begins with.
 *
 * exports:
 *   hasLaw(lab, object)                 whether its medium is given by coefficients
 *   whyUnused(lab, object, name)        why that parameter has no effect now; '' if it has one
 *   withMedium(lab, object, medium)     {path: value} to set for that medium: a law requires coefficients */

const value = (lab, object, name) => lab.param(`${object}.${name}`)?.value;

const lawsOf = (lab, object) => lab.param(`${object}.ior`)?.first_coefficients ?? {};

export const hasLaw = (lab, object) => value(lab, object, 'medium') in lawsOf(lab, object);

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
  const first = lawsOf(lab, object)[medium];
  if (!first) return set;
  const was = lab.param(`${object}.coefficients`)?.initial;
  const kept = lab.param(`${object}.medium`)?.initial === medium && was?.length;
  return { ...set, [`${object}.coefficients`]: kept ? was : first };
}
