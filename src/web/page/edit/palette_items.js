/* The things of an optical bench: what each consists of, where light meets it, and its drawing.
 *
 * Places are [u, v] in the plane of the bench, u to the right and v up, from the middle of the thing; s is its size in
 * scene units. A part lies (its axis is in the plane, to the right) or stands (its axis is across the plane), turned by
 * an angle from right to up. All parts are made of what /api/objects offers.
 *
 * exports:
 *   palette -> [[title, [item, ..]], ..]     item: {id, name, title, icon, make(s, options)}
 *     make(s, {lens}) -> {parts: [{name, shape, lies or stands: degrees, at: [u, v], from, set}], half: [u, v], beam}
 *       from: distance along the part's own axis from its position to its middle
 *       half: half the sides of a box around it; beam: {at: [u, v], angle, set}, light that shows what it does
 *   N                                        refractive indices at the d line, relative to vacuum (cuvette media)
 *   glassOf(medium) -> values of a clear solid */

import { svg } from '../shared/ui.js';

export const N = { bk7: 1.5172204533, sf11: 1.7852145253 };

const CLEAR = {
  transparency: 1,
  color: [1, 1, 1],
  ambient: 0,
  diffuse: 0,
  reflectivity: 0,
  specular: 0.6,
  shininess: 80,
};
export const glassOf = (medium) => ({ ...CLEAR, medium, priority: 1 });
const MIRROR = { color: [0.92, 0.94, 0.96], ambient: 0.02, diffuse: 0.02, specular: 0.6, reflectivity: 0.96 };
const WHITE = { color: [0.95, 0.95, 0.95], ambient: 0.25, diffuse: 0.7, specular: 0 };

const PARALLEL = { kind: 'sheet', rays: 7, branches: 'off' };
const RED = { lambda_nm: 632.8 };
const SPECTRUM = { white: 'on', wavelengths: 7, branches: 'off' };
const SOURCE = { kind: 'fan', rays: 9, angle_deg: 16, branches: 'off' };

const degrees = (radians) => (radians * 180) / Math.PI;
const thin = (s, width = 0.7) => ({ ...PARALLEL, width: width * s });

function lens(s, { lens: form }) {
  const { thickness: t, diameter } = form;
  const edge = Math.max(0, ...[form.radius_1, -form.radius_2].map((r) => (r < 0 ? diameter ** 2 / (8 * -r) : 0)));
  return {
    parts: [{ name: 'lens', shape: 'lens', lies: 0, at: [0, 0], from: t / 2, set: { ...form, ...glassOf('bk7') } }],
    half: [t / 2 + edge, diameter / 2],
    beam: { at: [0, 0], angle: 0, set: thin(diameter) },
  };
}

/* Light passes an equilateral prism at minimum deviation. */
function prism(s) {
  const incidence = degrees(Math.asin(N.sf11 * Math.sin(Math.PI / 6)));
  const set = { sides: 3, radius: s / Math.sqrt(3), height: s, ...glassOf('sf11') };
  return {
    parts: [{ name: 'prism', shape: 'prism', stands: 180, at: [0, 0], from: s / 2, set }],
    half: [0.5 * s, 0.58 * s],
    beam: { at: [-0.25 * s, 0.1443 * s], angle: incidence - 30, set: SPECTRUM },
  };
}

/* An equilateral prism, flattened; light enters one leg and is reflected totally at the long side. */
function rightPrism(s) {
  const radius = s / Math.sqrt(3);
  const set = { sides: 3, radius, height: s, scale: [1, 1, 1 / Math.sqrt(3)], ...glassOf('bk7') };
  return {
    parts: [{ name: 'prism', shape: 'prism', stands: 225, at: [0, 0], from: s / 2, set }],
    half: [0.45 * s, 0.45 * s],
    beam: { at: [0, 0], angle: 0, set: { ...RED, branches: 'off' } },
  };
}

/* A lens of a flat side and half a ball, turned about the middle of its flat side: light that is aimed there is not
 * refracted at the ball. */
function block(s) {
  const radius = 0.6 * s;
  const form = { radius_1: 0, radius_2: -radius, thickness: radius, diameter: 1.98 * radius };
  return {
    parts: [{ name: 'block', shape: 'lens', lies: 205, at: [0, 0], from: 0, set: { ...form, ...glassOf('bk7') } }],
    half: [0.6 * s, 0.6 * s],
    beam: { at: [0, 0], angle: 0, set: RED },
  };
}

function plate(s) {
  return {
    parts: [
      {
        name: 'plate',
        shape: 'box',
        stands: 35,
        at: [0, 0],
        from: 0,
        set: { size: [0.35 * s, s, s], ...glassOf('bk7') },
      },
    ],
    half: [0.45 * s, 0.52 * s],
    beam: { at: [0, 0], angle: 0, set: RED },
  };
}

function ball(s) {
  return {
    parts: [
      { name: 'ball', shape: 'sphere', stands: 0, at: [0, 0], from: 0, set: { radius: 0.4 * s, ...glassOf('bk7') } },
    ],
    half: [0.4 * s, 0.4 * s],
    beam: { at: [0, 0], angle: 0, set: thin(s, 0.5) },
  };
}

/* The light is aimed at the middle of the end. */
function fibre(s) {
  const [length, core, cladding] = [4 * s, 0.1 * s, 0.17 * s];
  return {
    parts: [
      {
        name: 'fibre',
        shape: 'cylinder',
        lies: 0,
        at: [0, 0],
        from: length / 2,
        set: { radius: core, height: length, ...glassOf('bk7'), priority: 2 },
      },
      {
        name: 'cladding',
        shape: 'cylinder',
        follows: true,
        set: { radius: cladding, height: length, ...glassOf('ior'), ior: 1.4 },
      },
    ],
    half: [length / 2, cladding],
    beam: { at: [-length / 2, 0], angle: 20, set: { ...RED, branches: 'off', depth: 40 } },
  };
}

function mirror(s) {
  return {
    parts: [
      { name: 'mirror', shape: 'box', stands: -45, at: [0, 0], from: 0, set: { size: [0.08 * s, s, s], ...MIRROR } },
    ],
    half: [0.4 * s, 0.4 * s],
    beam: { at: [0, 0], angle: 0, set: RED },
  };
}

/* side: of the centre of curvature; -1: concave to the light, which comes from the left. The focal length is 1.2 s. */
const curved = (side) => (s) => ({
  parts: [
    {
      name: 'mirror',
      shape: 'lens',
      lies: 0,
      at: [0, 0],
      from: 0,
      set: { radius_1: 2.4 * side * s, radius_2: 0, thickness: 0.14 * s, diameter: s, ...MIRROR },
    },
  ],
  half: [0.14 * s, 0.5 * s],
  beam: { at: [0, 0], angle: 0, set: thin(s) },
});

function screen(s) {
  return {
    parts: [
      { name: 'screen', shape: 'box', stands: 0, at: [0, 0], from: 0, set: { size: [0.06 * s, s, 1.6 * s], ...WHITE } },
    ],
    half: [0.1 * s, 0.8 * s],
    beam: { at: [0, 0], angle: 0, set: thin(s) },
    last: true,
  };
}

/* Light alone: its start is at the place. */
const light = (set) => (s) => ({ parts: [], half: [0, 0], beam: { at: [0, 0], angle: 0, set: set(s) } });

/* --- drawings: glass, metal and rays, 48 x 36 --- */

const drawn =
  ({ glass, metal, rays }) =>
  () =>
    svg(
      'svg',
      { class: 'palette-drawing', viewBox: '0 0 48 36', 'aria-hidden': 'true', focusable: 'false' },
      rays ? svg('path', { class: 'ray', d: rays }) : null,
      glass ? svg('path', { class: 'glass', d: glass }) : null,
      metal ? svg('path', { class: 'metal', d: metal }) : null,
    );

const item = (id, name, title, drawing, make) => ({ id, name, title, icon: drawn(drawing), make });

export const palette = [
  [
    'Glass',
    [
      item(
        'lens',
        'Lens',
        'A lens of glass, in the form chosen below, with parallel light',
        { glass: 'M20 4Q30 18 20 32Q10 18 20 4Z', rays: 'M1 10H20L42 18M1 18H46M1 26H20L42 18' },
        lens,
      ),
      item(
        'prism',
        'Prism',
        'A prism with three equal sides, with white light',
        { glass: 'M24 5L39 31H9Z', rays: 'M1 27L16 18H31L46 24M31 18L46 28' },
        prism,
      ),
      item(
        'right-prism',
        'Right-angled prism',
        'A prism that reflects light totally at its long side',
        { glass: 'M10 8H38L10 34Z', rays: 'M1 21H24V1' },
        rightPrism,
      ),
      item(
        'block',
        'D-block',
        'Half a disc of glass, with a ray to the middle of its flat side: turn it about this point',
        { glass: 'M26 4A14 14 0 0 0 26 32Z', rays: 'M1 26L26 18L46 6' },
        block,
      ),
      item(
        'plate',
        'Plate',
        'A plate of glass with parallel sides, at an angle to a ray',
        { glass: 'M18 3L30 8L28 33L16 28Z', rays: 'M1 14H18L29 20H46' },
        plate,
      ),
      item(
        'ball',
        'Ball',
        'A ball of glass, with parallel light',
        { glass: 'M33 18A12 12 0 1 1 9 18A12 12 0 1 1 33 18Z', rays: 'M1 12H11L32 16L46 20M1 24H11L32 20L46 16' },
        ball,
      ),
      item(
        'fibre',
        'Fibre',
        'A thick fibre of glass with its cladding, with a ray that cannot leave it',
        { glass: 'M9 12H46V24H9Z', rays: 'M1 25L9 18L16 12L28 24L40 12L46 18' },
        fibre,
      ),
    ],
  ],
  [
    'Mirrors and screen',
    [
      item(
        'mirror',
        'Flat mirror',
        'A flat mirror at 45 degrees to a ray',
        { metal: 'M14 31L36 9L39 12L17 34Z', rays: 'M1 21H24V1' },
        mirror,
      ),
      item(
        'concave',
        'Concave mirror',
        'A mirror that collects parallel light',
        { metal: 'M30 3Q38 18 30 33H38V3Z', rays: 'M1 10H33L14 18M1 26H33L14 18' },
        curved(-1),
      ),
      item(
        'convex',
        'Convex mirror',
        'A mirror that spreads parallel light',
        { metal: 'M36 3Q24 18 36 33H40V3Z', rays: 'M1 13H31L12 3M1 23H31L12 33' },
        curved(1),
      ),
      item(
        'screen',
        'White screen',
        'A screen on which light ends',
        { metal: 'M34 3H38V33H34Z', rays: 'M1 10L34 16M1 18H34M1 26L34 20' },
        screen,
      ),
    ],
  ],
  [
    'Light',
    [
      item('parallel', 'Parallel beam', 'Parallel rays', { rays: 'M4 9H44M4 18H44M4 27H44' }, light(thin)),
      item(
        'source',
        'Point source',
        'Rays from one point, as from a point of an object',
        { metal: 'M9 18A3 3 0 1 1 3 18A3 3 0 1 1 9 18Z', rays: 'M6 18L44 6M6 18H46M6 18L44 30' },
        light(() => SOURCE),
      ),
      item(
        'ray',
        'Single ray',
        'A thin laser beam',
        { rays: 'M4 18H44M36 13L44 18L36 23' },
        light(() => RED),
      ),
      item(
        'white',
        'White ray',
        'A thin beam of all colours',
        { rays: 'M4 18H26L44 13M26 18L45 18M26 18L44 23' },
        light(() => SPECTRUM),
      ),
    ],
  ],
];
