/* A pixel's ray tree from /api/trace as a list, and the texts for each ray. Pure functions without page and server.
 *
 * A line of a ray has `from` and `along`, [x, y, z], and `end`: its points are from + s along for 0 <= s <= end. The
 * program decides where rays end, `far_end` of the API (render/inspect/ray_line.h): a ray that leaves the scene has no
 * end (Infinity), and its line runs to the edge of the frame.
 *
 * exports:
 *   buildTree(answer) -> {answer, rays, roots, reach}
 *     rays: in the order of the table, each {index, node, parent, level, children, weight, line}; weight: 0..1,
 *     relative to the camera ray; line: a short stub for a ray that was cut off; reach: extent of the hits
 *   isCut(ray)                           whether the ray was cut off by depth or weight
 *   lineClass(ray)                       the class of its line in a drawing
 *   inkOf(weight) -> {part, seen}        how a line shows the power of its ray, in all drawings of the page;
 *   inked(node, weight, widest), edged(node, weight, widest, edge) -> node     gives it to a line, and to its edge
 *   kinds                                [class, description] of each, for legends
 *   columns, describe(ray)               [key, head, title] of the table's columns, and the texts of a row
 *   lineTo(from, farEnd), lineBetween(from, to) -> line
 *   pointAt(line, s) -> [x, y, z]
 *   seenLine(line, camera, {width, height}, frame) -> [[x, y, s], [x, y, s]] or null
 *     the part that the camera of the state sees in the frame, in pixels of an image of that size
 *   flatLine(line, {u, v}, frame) -> [[u, v], [u, v]] or null
 *     the part whose projection onto the axes is in the frame
 *   frame: {left, top, right, bottom}; for flatLine v increases from bottom to top */

import { local, say } from '../shared/language.js';
import { digits } from '../shared/ui.js';
import { add, dot, length, mean, minus, times } from '../shared/vectors.js';

const NEAR = 1e-6; /* the constants of render/inspect/ray_line.c */
const NEAR_OF_EYE = 1e-9;
const ALONG_THE_VIEW = 1e-12;

/* Of a ray with the fraction w of the beam's power, the part of the full width, sqrt w, and the opacity, the cube root
 * of w, as the eye sees the lightness of a luminance w (CIE L*). Both have a least value, so that it can be seen. */
export const inkOf = (weight) => {
  const w = Math.min(1, Math.max(0, weight));
  return { part: Math.max(0.25, Math.sqrt(w)), seen: Math.max(0.12, Math.cbrt(w)) };
};

/* The width and opacity of a line; a style sheet gives it another full width by --part. */
export function inked(node, weight, widest) {
  const { part, seen } = inkOf(weight);
  node.setAttribute('stroke-width', (widest * part).toFixed(2));
  node.setAttribute('stroke-opacity', seen.toFixed(3));
  node.style.setProperty('--part', part.toFixed(3));
  return node;
}

/* The dark edge of that line. */
export function edged(node, weight, widest, edge) {
  const { part, seen } = inkOf(weight);
  node.setAttribute('stroke-width', (widest * part + edge).toFixed(2));
  node.setAttribute('opacity', seen.toFixed(3));
  node.style.setProperty('--part', part.toFixed(3));
  return node;
}

export const lineBetween = (from, to) => ({ from, along: minus(to, from), end: 1 });

export function lineTo(from, [x, y, z, w]) {
  return w ? lineBetween(from, [x, y, z]) : { from, along: [x, y, z], end: Infinity };
}

export const pointAt = ({ from, along }, s) => add(from, times(along, s));

/* The interval [first, last] of 0..end in which every start + s slope is >= 0, or null (Liang and Barsky). */
function within(end, conditions) {
  let [first, last] = [0, end];
  for (const [start, slope] of conditions) {
    if (slope === 0 && start < 0) return null;
    if (slope > 0) first = Math.max(first, -start / slope);
    if (slope < 0) last = Math.min(last, -start / slope);
  }
  return first < last ? [first, last] : null;
}

/* In a parallel view, a line along the view is a point. */
const flattened = ([x, y, z]) => (Math.hypot(x, y) <= ALONG_THE_VIEW * Math.abs(z) ? [0, 0, z] : [x, y, z]);

export function seenLine(line, camera, { width, height }, frame) {
  const { eye, forward, right, up, half_width: halfWidth, half_height: halfHeight, parallel } = camera;
  const offset = minus(line.from, eye);
  const inView = (v) => [dot(v, right), dot(v, up), dot(v, forward)];
  const inImage = ([x, y, z]) => [x / halfWidth, y / halfHeight, z];
  const from = inImage(inView(offset));
  const along = inImage(parallel ? flattened(inView(line.along)) : inView(line.along));
  const near = parallel ? 0 : NEAR * length(offset) + NEAR_OF_EYE * length(eye);
  const [spread, widening] = parallel ? [1, 0] : [from[2], along[2]];
  const edge = (axis, side, sign) => [sign * (from[axis] - side * spread), sign * (along[axis] - side * widening)];
  const leavesPastPlane = parallel && line.end === Infinity && from[2] >= 0;
  const found = within(line.end, [
    ...(leavesPastPlane ? [] : [[from[2] - near, along[2]]]),
    edge(0, (2 * frame.left) / width - 1, 1),
    edge(0, (2 * frame.right) / width - 1, -1),
    edge(1, 1 - (2 * frame.bottom) / height, 1),
    edge(1, 1 - (2 * frame.top) / height, -1),
  ]);
  /* In perspective, the end of an endless line and a point next to the eye are seen in the line's direction. */
  const image = (s) => {
    const point = add(from, times(along, Number.isFinite(s) ? s : 0));
    const [x, y, z] = !parallel && (!Number.isFinite(s) || point[2] <= 0) ? along : point;
    const size = parallel ? 1 : z;
    return [((1 + x / size) / 2) * width, ((1 - y / size) / 2) * height, s];
  };
  return found && found.map(image);
}

export function flatLine(line, { u, v }, { left, top, right, bottom }) {
  const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const [x, y] = [dot(line.from, u), dot(line.from, v)];
  const along = flattened([dot(line.along, u), dot(line.along, v), dot(line.along, normal)]);
  const found = within(line.end, [
    [x - left, along[0]],
    [right - x, -along[0]],
    [y - bottom, along[1]],
    [top - y, -along[1]],
  ]);
  return found && found.map((s) => (Number.isFinite(s) ? [x + s * along[0], y + s * along[1]] : [x, y]));
}

const CUT = 0.15; /* length of the stub of a cut ray, as a fraction of the extent of the hits */

export const kinds = [
  ['ray-camera', 'camera ray'],
  ['ray-reflect', say('reflected')],
  ['ray-refract', say('refracted')],
  ['ray-shadow', 'to a light'],
  ['ray-blocked', 'shadow ray, blocked'],
  ['ray-cut', 'cut off'],
];

const kindWords = {
  camera: say('camera ray'),
  reflect: say('reflected'),
  refract: say('refracted'),
  shadow: say('to a light'),
};

const endWords = {
  hit: say('hits a surface'),
  sky: say('background'),
  cut_depth: say('cut off: depth limit'),
  cut_weight: say('cut off: weight too small'),
  lit: say('unoccluded'),
  blocked: say('blocked'),
};

export const isCut = ({ node }) => node.end === 'cut_depth' || node.end === 'cut_weight';

export function lineClass(ray) {
  if (isCut(ray)) return 'ray ray-cut';
  return ray.node.end === 'blocked' ? 'ray ray-blocked' : `ray ray-${ray.node.kind}`;
}

export function buildTree(answer) {
  const first = answer.roots || [answer.root];
  const cameraLight = mean(first[0].throughput) || 1;
  const rays = [];
  const roots = [];
  /* A loop, not a recursion: a beam without branches has up to 10 000 levels, too many for a browser's stack. */
  const waiting = first.map((node) => ({ node, parent: null, level: 1 })).reverse();
  while (waiting.length) {
    const { node, parent, level } = waiting.pop();
    const ray = { index: rays.length, node, parent, level, children: [] };
    /* A shadow ray's throughput is a radiance, so it gets the weight of its parent ray. */
    ray.weight = node.kind === 'shadow' && parent ? parent.weight : Math.min(1, mean(node.throughput) / cameraLight);
    rays.push(ray);
    (parent ? parent.children : roots).push(ray);
    for (const child of [...node.children].reverse()) waiting.push({ node: child, parent: ray, level: level + 1 });
  }
  const reach = extent(rays);
  for (const ray of rays) {
    const { origin: from, direction, far_end: farEnd } = ray.node;
    ray.line = isCut(ray) ? { from, along: direction, end: CUT * reach } : lineTo(from, farEnd);
  }
  return { answer, rays, roots, reach };
}

/* The extent of the hits; for a single hit, a part of its distance. */
function extent(rays) {
  const hits = rays.filter((ray) => ray.node.hit).map((ray) => ray.node.hit);
  if (!hits.length) return 1;
  const sides = [0, 1, 2].map((k) => {
    let low = Infinity;
    let high = -Infinity;
    for (const { point } of hits) {
      low = Math.min(low, point[k]);
      high = Math.max(high, point[k]);
    }
    return high - low;
  });
  return Math.max(length(sides), 0.25 * hits[0].t);
}

/* --- texts --- */

export const columns = [
  ['kind', 'Ray', 'origin of the ray'],
  ['media', 'Media', 'on both sides of the surface, with refractive indices'],
  ['angles', 'Angles', 'angles of incidence and refraction, from the normal'],
  ['reflectance', 'R', 'reflectance of unpolarised light'],
  ['transmitted', 'T', 'transmittance of the surface'],
  ['polarised', 'R_s, R_p', 'reflectance of each polarisation'],
  ['surface', 'Hits', 'solid and surface'],
  ['depth', 'Depth', 'number of reflections and refractions since the camera'],
  ['path', 'Path', 'length of the ray up to the hit'],
  [
    'transmittance',
    'Transmittance',
    'fraction of the light that the medium transmits on the path; red, green, blue if they differ',
  ],
  ['weight', 'Weight', "fraction of the ray's light that reaches the pixel"],
  ['contribution', 'Contribution', 'radiance that this ray itself adds to the pixel'],
  ['end', 'End', 'how the ray ends'],
];

const percent = (value) => `${digits(100 * value, 3)} %`;
const degrees = (angle) => `${digits(angle, 4)}°`;

/* One number if the channels are equal, otherwise three. */
const channels = (c) => (c[0] === c[1] && c[1] === c[2] ? digits(c[0], 3) : c.map((x) => digits(x, 3)).join(' · '));

const medium = ({ medium: name, n }) => (local(name) === digits(n) ? digits(n) : `${name} ${digits(n)}`);

function surface(hit) {
  return hit.surface_of ? say('{solid}: {surface} of {surface_of}', hit) : `${hit.solid}: ${hit.surface}`;
}

function angles({ opaque, tir, snell }) {
  const incidence = degrees(snell.incidence_deg);
  if (opaque) return incidence;
  return tir ? say('{incidence}, no refraction', { incidence }) : `${incidence} → ${degrees(snell.refraction_deg)}`;
}

function reflectance(hit) {
  if (hit.tir) return say('total reflection');
  if (hit.opaque) return hit.R > 0 ? say('{reflectance}, opaque', { reflectance: percent(hit.R) }) : say('opaque');
  return percent(hit.R);
}

function hitTexts(hit) {
  return {
    surface: surface(hit),
    media: hit.opaque ? say('in {medium}', { medium: medium(hit.from) }) : `${medium(hit.from)} → ${medium(hit.to)}`,
    angles: angles(hit),
    reflectance: reflectance(hit),
    transmitted: hit.opaque || hit.tir ? '' : percent(hit.T),
    polarised: hit.opaque || hit.tir ? '' : `${percent(hit.R_s)}, ${percent(hit.R_p)}`,
    path: `${digits(hit.path_length)} m`,
    transmittance: channels(hit.transmittance),
  };
}

export function describe(ray) {
  const { node } = ray;
  return {
    kind: node.kind === 'shadow' && node.light ? say('to {light}', node) : kindWords[node.kind],
    depth: String(node.depth),
    surface: '',
    media: say('in {medium}', { medium: medium(node) }),
    angles: '',
    reflectance: '',
    transmitted: '',
    polarised: '',
    path: '',
    transmittance: '',
    weight: channels(node.throughput),
    contribution: node.contribution.some((x) => x !== 0) ? channels(node.contribution) : '',
    end: endWords[node.end] || node.end,
    ...(node.hit ? hitTexts(node.hit) : {}),
  };
}
