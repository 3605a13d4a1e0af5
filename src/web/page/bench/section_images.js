/* Where the rays of a beam meet in a section, or seem to come from: real and virtual images, with the rays' extensions
 * backwards, and the lens formula with what is measured there.
 *
 * Of a beam, the rays that go the same way (by their strongest branches) are one group; the image is where the ray that
 * is refracted least meets its neighbours.
 *
 * exports:
 *   imagesOf(lab, plane, segments) -> [{beam, real, point: of a point source, at: [u, v], backward: [[[u, v], [u, v]],
 *     ..], formula}]
 *     backward: extensions of the rays of a virtual image; formula: {solid, mirror, a, b, f, from, planes} or null: a
 *     (Infinity: parallel light) and b are measured, f follows from the radii; from: [u, v] of the source; planes: [[u,
 *     v], [u, v]] on the axis, from which a and b are measured
 *   imageMarks(port, images, room) -> SVG elements; room: boxes of labels that exist */

import { focalLength, principalPlanes } from '../edit/lens_maker.js';
import { say } from '../shared/language.js';
import { svg } from '../shared/ui.js';
import { add, dot, minus, times } from '../shared/vectors.js';
import { turned } from '../view/solids.js';
import { flat } from './section_plane.js';

const IN_PLANE = 1e-4; /* slope out of the plane */
const MISS = 0.02; /* of the distance: neighbours that miss each other by more have no image */
const FAR = 300; /* distance in units of the spread of the rays: parallel */
const LEAST = 3; /* rays */

/* The strongest branches of a ray, up to its end. */
function mainPath(root) {
  const path = [root];
  for (let at = root; at.children.length; path.push(at))
    at = at.children.reduce((best, each) => (each.weight > best.weight ? each : best));
  return path;
}

function pathsOf(plane, segments) {
  const trees = new Map(segments.map((segment) => [segment.tree, segment]));
  return [...trees.values()]
    .filter(({ tree }) => tree.roots[0].node.hit)
    .map(({ beam, ray, tree }) => ({ beam, ray, path: mainPath(tree.roots[0]) }))
    .filter(({ path }) => path.length > 1)
    .filter(({ path }) => path.every(({ line }) => Math.abs(dot(line.along, plane.normal)) <= IN_PLANE))
    .map((each) => ({ ...each, last: each.path[each.path.length - 1], hits: each.path.map(({ node }) => node.hit) }));
}

/* Groups of one beam, wavelength and way. */
function groupsOf(paths) {
  const groups = new Map();
  for (const path of paths) {
    const way = path.hits.map((hit) => (hit ? `${hit.solid} ${hit.surface}` : '')).join('>');
    const key = `${path.beam}|${path.ray.lambda_nm}|${way}`;
    if (!groups.has(key)) groups.set(key, []);
    groups.get(key).push(path);
  }
  return [...groups.values()].filter((group) => group.length >= LEAST);
}

/* The point that is nearest to some lines of the plane, each [u, v] and a direction of length 1. */
function meeting(lines) {
  let [a, b, c, p, q] = [0, 0, 0, 0, 0];
  for (const [[u, v], [du, dv]] of lines) {
    const across = -dv * u + du * v;
    a += dv * dv;
    b -= du * dv;
    c += du * du;
    p -= dv * across;
    q += du * across;
  }
  const size = a * c - b * b;
  return Math.abs(size) < 1e-14 ? null : [(p * c - q * b) / size, (a * q - b * p) / size];
}

function lineIn(plane, { line }) {
  const [u, v] = flat(plane, line.from);
  const [du, dv] = [dot(line.along, plane.right), dot(line.along, plane.up)];
  const length = Math.hypot(du, dv);
  return [[u, v], [du / length, dv / length], line.end * length];
}

const steepest = ({ hits }) => Math.max(...hits.filter(Boolean).map((hit) => hit.snell.incidence_deg));

function imageOf(lab, plane, group) {
  const lines = group.map(({ last }) => lineIn(plane, last));
  const angles = group.map(steepest);
  const chief = Math.min(Math.max(angles.indexOf(Math.min(...angles)), 1), group.length - 2);
  const near = lines.slice(chief - 1, chief + 2);
  const at = meeting(near);
  if (!at) return null;
  const along = ([[u, v], [du, dv]]) => (at[0] - u) * du + (at[1] - v) * dv;
  const across = ([[u, v], [du, dv]]) => Math.abs((at[0] - u) * dv - (at[1] - v) * du);
  const spread = Math.hypot(near[0][0][0] - near[2][0][0], near[0][0][1] - near[2][0][1]);
  const away = along(near[1]);
  if (Math.max(...near.map(across)) > MISS * Math.abs(away) || Math.abs(away) > FAR * spread) return null;
  if (away > near[1][2]) return null; /* something is in the way */
  const { beam } = group[0];
  const point = ['pencil', 'fan'].includes(lab.param(`${beam}.kind`)?.value);
  const image = { beam, real: away > 0, point, at, weight: group.length };
  image.backward = image.real ? [] : lines.filter((line) => along(line) < 0).map((line) => [line[0], at]);
  image.formula = formulaOf(lab, plane, group[chief], image);
  return image;
}

/* Of white light only the middle wavelength. */
export function imagesOf(lab, plane, segments) {
  const best = new Map();
  for (const group of groupsOf(pathsOf(plane, segments))) {
    const { beam, ray } = group[0];
    const off = Math.abs(ray.lambda_nm - 550) - 1e4 * group.length;
    if (!best.has(beam) || off < best.get(beam).off) best.set(beam, { off, group });
  }
  return [...best.values()].map(({ group }) => imageOf(lab, plane, group)).filter(Boolean);
}

/* --- 1/a + 1/b = 1/f --- */

/* A single lens, or a single curved mirror, that the light meets before it ends. */
function formulaOf(lab, plane, { path, hits }, image) {
  const met = hits.filter((hit) => hit && (!hit.opaque || hit.R > 0));
  const { solid } = met[0];
  const mirror = met[0].opaque;
  if (lab.object(solid)?.shape !== 'lens' || met.length !== (mirror ? 1 : 2) || met.some((hit) => hit.solid !== solid))
    return null;
  const of = (row) => lab.param(`${solid}.${row}`)?.value;
  const lens = { radius_1: of('radius_1'), radius_2: of('radius_2'), thickness: of('thickness') };
  const [place, rotation] = [of('position'), of('rotation')];
  if (!place || (!lens.radius_1 && !lens.radius_2)) return null;
  const axis = turned([0, 1, 0], rotation);
  const sense = Math.sign(dot(path[0].line.along, axis));
  const n = met[0].to.n / met[0].from.n;
  const radius = sense > 0 ? lens.radius_1 : lens.radius_2;
  const f = mirror ? (-sense * radius) / 2 : focalLength(lens, n);
  if (!Number.isFinite(f) || f === 0) return null;
  const vertex = sense > 0 ? 0 : lens.thickness;
  const [first, second] = mirror ? [vertex, vertex] : principalPlanes(lens, n);
  const ends = (sense > 0 ? [first, second] : [second, first]).map((at) => add(place, times(axis, at)));
  const source = path[0].line.from;
  const world = [times(plane.right, image.at[0]), times(plane.up, image.at[1])].reduce(add, plane.origin);
  const out = mirror ? -sense : sense;
  return {
    solid,
    mirror,
    f,
    a: image.point ? sense * dot(minus(ends[0], source), axis) : Infinity,
    b: out * dot(minus(world, ends[1]), axis),
    from: flat(plane, source).slice(0, 2),
    planes: ends.map((end) => flat(plane, end).slice(0, 2)),
  };
}

/* --- marks --- */

const CROSS = 6;

function nameOf({ real, point }) {
  if (point) return real ? say('real image') : say('virtual image');
  return real ? say('focus') : say('virtual focus');
}

export function imageMarks(port, images, room) {
  return images.flatMap((image) => {
    const [x, y] = [port.x(image.at[0]), port.y(image.at[1])];
    const text = nameOf(image);
    const width = 8 + 6.8 * text.length;
    const covers = ([left, top, right, bottom]) =>
      x - width / 2 < right && x + width / 2 > left && y - 34 < bottom && y - 12 > top;
    const shift = room.some(covers) ? 44 : 0;
    room.push([x - width / 2, y - 32 + shift, x + width / 2, y - 14 + shift]);
    return [
      ...image.backward.map(([a, b]) =>
        svg('path', {
          class: 'section-extension',
          d: `M${[a, b].map(([u, v]) => `${port.x(u).toFixed(1)} ${port.y(v).toFixed(1)}`).join('L')}`,
        }),
      ),
      ...dimensions(port, image),
      svg('path', {
        class: 'section-image',
        d: `M${x - CROSS} ${y - CROSS}l${2 * CROSS} ${2 * CROSS}m0 ${-2 * CROSS}l${-2 * CROSS} ${2 * CROSS}`,
      }),
      svg('rect', { class: 'section-plate', x: x - width / 2, y: y - 32 + shift, width, height: 18, rx: 4 }),
      svg('text', { class: 'section-angle', x, y: y - 19 + shift, 'text-anchor': 'middle' }, text),
    ];
  });
}

/* a and b as lengths below the axis. */
function dimensions(port, { formula, at }) {
  if (!formula) return [];
  const { a, b, from, planes } = formula;
  const low = Math.max(...[from, at, ...planes].map(([, v]) => port.y(v))) + 34;
  const length = (p, q, name) => {
    const [x0, x1] = [port.x(p[0]), port.x(q[0])];
    if (Math.abs(x1 - x0) < 12 || Math.abs(p[1] - q[1]) * port.scale > 60) return [];
    return [
      svg('path', {
        class: 'section-length',
        d: `M${x0} ${low - 5}V${low + 5}M${x0} ${low}H${x1}M${x1} ${low - 5}V${low + 5}`,
      }),
      svg('rect', { class: 'section-plate', x: (x0 + x1) / 2 - 9, y: low - 9, width: 18, height: 18, rx: 4 }),
      svg('text', { class: 'section-angle', x: (x0 + x1) / 2, y: low + 4, 'text-anchor': 'middle' }, name),
    ];
  };
  return [...(Number.isFinite(a) ? length(from, planes[0], 'a') : []), ...(b ? length(planes[1], at, 'b') : [])];
}
