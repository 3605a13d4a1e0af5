/* Ruler and protractor: numbers from points in the scene. Pure functions.
 *
 * exports:
 *   degrees(angle_deg, n)         the angle as text with n digits
 *   measure(points) -> [[name, text]]    distances of successive points; for three, the angle at the second
 *   hitFacts(segment) -> [[name, text]]  Snell's and Fresnel's numbers at the end of a segment */

import { say } from '../shared/language.js';
import { digits, vector } from '../shared/ui.js';
import { dot, length, minus, unit } from '../shared/vectors.js';

const DIGITS = 8;

const angleOf = (cosine) => (Math.acos(Math.min(1, Math.max(-1, cosine))) * 180) / Math.PI;
export const degrees = (angle, n) => `${digits(angle, n)}°`;
const number = (x) => digits(x, DIGITS);

export function measure(points) {
  const list = points.map((point, i) => [say('Point {number}', { number: i + 1 }), vector(point, 6)]);
  for (let i = 1; i < points.length; i++)
    list.push([
      say('Distance {from}–{to}', { from: i, to: i + 1 }),
      say('{length} scene units', { length: number(length(minus(points[i], points[i - 1]))) }),
    ]);
  if (points.length === 3) {
    const [a, b] = [unit(minus(points[0], points[1])), unit(minus(points[2], points[1]))];
    if (a && b) list.push(['Angle at point 2', degrees(angleOf(dot(a, b)), DIGITS)]);
  }
  return list;
}

export function hitFacts({ beam, ray, one, power }) {
  const { node } = one;
  const { hit } = node;
  const snell = hit?.snell;
  const list = [
    [
      'Beam',
      say('{beam}, ray {number}, {wavelength} nm', {
        beam,
        number: ray.number + 1,
        wavelength: digits(ray.lambda_nm, 6),
      }),
    ],
    [
      'Power at its start',
      say('{power} ({percent} % of the ray)', {
        power: number(power),
        percent: number((100 * power) / ray.power),
      }),
    ],
    ['Medium', `${node.medium}, n ${number(node.n)}`],
  ];
  if (!hit) return [...list, ['Ends', node.end === 'sky' ? 'in the background' : 'at the limit of depth or power']];
  list.push(
    ['Hits', `${hit.solid}, ${hit.surface}`],
    ['Length', say('{length} scene units', { length: number(hit.t) })],
    ['Point', vector(hit.point, 6)],
    ['Normal', vector(hit.normal, 6)],
    ['Angle of incidence', degrees(snell.incidence_deg, DIGITS)],
  );
  if (hit.opaque) return [...list, ['Surface', say('opaque, R {R}', { R: number(hit.R) })]];
  list.push(
    ['Angle of refraction', hit.tir ? 'none: total reflection' : degrees(snell.refraction_deg, DIGITS)],
    ['n₁ → n₂', `${number(hit.from.n)} (${hit.from.medium}) → ${number(hit.to.n)} (${hit.to.medium})`],
    ['n₁ sin i', number(snell.n_sin_i)],
    ['n₂ sin t', hit.tir ? `${number(snell.n_sin_i)} > n₂` : number(snell.n_sin_t)],
    ['R_s, R_p', `${number(hit.R_s)}, ${number(hit.R_p)}`],
    ['R, T', `${number(hit.R)}, ${number(hit.T)}`],
  );
  return list;
}
