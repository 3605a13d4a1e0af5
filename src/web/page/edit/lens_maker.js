/* The lensmaker's equation for a lens of index n in air with its thickness d: 1/f = (n - 1) (1/R1 - 1/R2 +
 * (n - 1) d / (n R1 R2)); a radius of 0 is a flat side, one above 0 has its centre on the side of the outgoing light.
 * Pure functions.
 * exports:
 *   focalLength({radius_1, radius_2, thickness}, n) -> f; Infinity for a lens without power
 *   principalPlanes({radius_1, radius_2, thickness}, n) -> [from side 1 to H, from side 1 to H']
 *   lensKinds -> [[word, label, whether it collects light], ..]
 *   lensOfFocus(kind, f, n, diameter) -> {radius_1, radius_2, thickness, diameter}; kind as in lensKinds
 *   lensOfRadii(radius_1, radius_2, diameter) -> the same */

const curvature = (radius) => (radius === 0 ? 0 : 1 / radius);

function power({ radius_1: r1, radius_2: r2, thickness }, n) {
  const [a, b] = [curvature(r1), curvature(r2)];
  return (n - 1) * (a - b + ((n - 1) * thickness * a * b) / n);
}

export const focalLength = (lens, n) => 1 / power(lens, n);

export function principalPlanes(lens, n) {
  const f = focalLength(lens, n);
  const shift = (radius) => -((f * (n - 1) * lens.thickness) / n) * curvature(radius);
  return [shift(lens.radius_2), lens.thickness + shift(lens.radius_1)];
}

/* The curvatures of the two sides, relative to each other. */
const SIDES = {
  biconvex: [1, -1],
  planoconvex: [1, 0],
  meniscus: [1, 0.4],
  biconcave: [-1, 1],
  planoconcave: [-1, 0],
};

export const lensKinds = [
  ['biconvex', 'Biconvex', true],
  ['planoconvex', 'Plano-convex', true],
  ['meniscus', 'Meniscus', true],
  ['biconcave', 'Biconcave', false],
  ['planoconcave', 'Plano-concave', false],
];

const STEEPEST = 0.92; /* of the half diameter over the smallest radius */
const THIN = 0.06; /* of the edge, or of the middle, over the diameter */

const sag = (radius, half) => (radius === 0 ? 0 : radius - Math.sign(radius) * Math.sqrt(radius ** 2 - half ** 2));

/* A lens whose sides are far enough apart, with the largest diameter that its radii allow. */
export function lensOfRadii(r1, r2, widest) {
  const least = Math.min(...[r1, r2].filter(Boolean).map(Math.abs), Infinity);
  const diameter = Math.min(widest, 2 * STEEPEST * least);
  const bulge = sag(r1, diameter / 2) - sag(r2, diameter / 2);
  return { radius_1: r1, radius_2: r2, thickness: THIN * widest + Math.max(0, bulge), diameter };
}

/* The thickness follows from the radius: by bisection of the curvature, of which the power is a monotone function. */
export function lensOfFocus(kind, f, n, diameter) {
  const sides = SIDES[kind];
  const of = (size) => {
    const [r1, r2] = sides.map((side) => (side === 0 ? 0 : size / side));
    return lensOfRadii(r1, r2, diameter);
  };
  const sought = 1 / Math.abs(f);
  let [low, high] = [1e-6, 1e6].map((factor) => factor * Math.abs(f));
  for (let k = 0; k < 200; k++) {
    const middle = Math.sqrt(low * high);
    if (Math.abs(power(of(middle), n)) > sought) low = middle;
    else high = middle;
  }
  return of(high);
}
