/* The rays of the beams in a section: their lines to the edge with arrowheads, and the marks of the hits: normal,
 * angles and refractive indices.
 * exports:
 *   rayMarks(port, plane, segments) -> elements
 *   extensionMarks(port, plane, segments) -> elements   dashed lines backwards from rays that leave the scene
 *   hitsOf(port, plane, segments) -> [{key, segment, hit, x, y, weight, aside}]  the hits in the window, strongest
 *                                  first; aside: the ray is not in the plane, and is drawn as its projection
 *   hitName(hit) -> text           for screen readers
 *   hitMarks(port, plane, hit, {full, room, bare}) -> elements   full: with the indices, and all digits; room: boxes
 *                                  of labels that exist; none if a label would cover one of them, unless full; bare:
 *                                  only the normal */

import { say } from '../shared/language.js';
import { digits, svg } from '../shared/ui.js';
import { dot } from '../shared/vectors.js';
import { flatLine, inked, isCut } from './ray_tree.js';
import { flat } from './section_plane.js';

const LINES_MAX = 3000;
const LIGHTEST = 0.001; /* fraction of a ray's power below which its branches are not drawn */
const EXTENDED = 0.05; /* fraction of a ray's power from which it is extended backwards */
const IN_PLANE = 1e-3; /* distance from the plane, in heights of the window */
const WIDEST = 2.2; /* CSS pixels, of a ray with all its power */
const ARROW_PX = 7;
const ARROW_LEAST_PX = 44; /* shorter pieces have no arrowhead */

const toLinear = (byte) => (byte <= 10 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
const toByte = (x) => Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));

/* The colour on a light page: a white or yellow line would not be seen there. */
const inks = new Map();
function inkOf(rgb) {
  const key = rgb.join(' ');
  if (!inks.has(key)) {
    const linear = rgb.map(toLinear);
    const luminance = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    const [dark, pale] = [Math.min(1, 0.3 / Math.max(luminance, 1e-9)), Math.max(0, 0.1 - luminance)];
    const onWhite = linear.map((x) => toByte(x * dark));
    const onBlack = linear.map((x) => toByte(Math.min(1, x + pale)));
    inks.set(key, `light-dark(rgb(${onWhite.join(' ')}), rgb(${onBlack.join(' ')}))`);
  }
  return inks.get(key);
}

const frameOf = (port) => {
  const [left, right, bottom, top] = port.extent();
  return { left, right, bottom, top };
};

function isAside(port, plane, { line }) {
  const limit = (IN_PLANE * port.height) / port.scale;
  const slope = Math.abs(dot(line.along, plane.normal));
  const reach = Number.isFinite(line.end) ? line.end : port.height / port.scale;
  return Math.abs(flat(plane, line.from)[2]) > limit || slope * reach > limit;
}

/* An arrowhead in the middle of a piece, or at its end if the ray leaves the window. */
function arrow([x1, y1], [x2, y2], leaves) {
  const length = Math.hypot(x2 - x1, y2 - y1);
  if (length < ARROW_LEAST_PX) return '';
  const [dx, dy] = [(x2 - x1) / length, (y2 - y1) / length];
  const at = leaves ? length - 3 : length / 2 + ARROW_PX / 2;
  const [x, y] = [x1 + dx * at, y1 + dy * at];
  const back = (side) => [x - ARROW_PX * (dx - side * 0.45 * dy), y - ARROW_PX * (dy + side * 0.45 * dx)];
  return `M${back(1).map(round)}L${round(x)} ${round(y)}L${back(-1).map(round)}`;
}

const round = (x) => Number(x.toFixed(2));

export function rayMarks(port, plane, segments) {
  const frame = frameOf(port);
  const axes = { u: plane.right, v: plane.up };
  const shown = segments.filter(({ one }) => one.weight >= LIGHTEST).slice(0, LINES_MAX);
  return shown.flatMap((segment) => {
    const ends = flatLine(segment.line, axes, frame);
    if (!ends) return [];
    const [a, b] = ends.map(([u, v]) => [port.x(u), port.y(v)]);
    const leaves = b[0] < 1 || b[1] < 1 || b[0] > port.width - 1 || b[1] > port.height - 1;
    const cut = isCut(segment.one);
    const node = svg('path', {
      class: `section-ray${isAside(port, plane, segment) ? ' aside' : ''}${cut ? ' cut' : ''}`,
      d: `M${a.map(round)}L${b.map(round)}${cut ? '' : arrow(a, b, leaves)}`,
    });
    inked(node, segment.one.weight, WIDEST);
    node.style.setProperty('stroke', inkOf(segment.ray.displayed));
    node.dataset.beam = segment.beam;
    return [node];
  });
}

export function extensionMarks(port, plane, segments) {
  const axes = { u: plane.right, v: plane.up };
  const last = segments.filter(({ one }) => !one.node.hit && one.level > 1 && one.weight >= EXTENDED);
  return last.flatMap(({ line }) => {
    const back = { from: line.from, along: line.along.map((x) => -x), end: Infinity };
    const ends = flatLine(back, axes, frameOf(port));
    const points = ends?.map(([u, v]) => [port.x(u), port.y(v)].map(round).join(' '));
    return ends ? [svg('path', { d: `M${points.join('L')}` })] : [];
  });
}

export function hitsOf(port, plane, segments) {
  return segments
    .filter(({ one }) => one.node.hit && one.weight >= LIGHTEST)
    .map((segment) => {
      const [u, v] = flat(plane, segment.one.node.hit.point);
      const { beam, ray, one } = segment;
      return {
        key: `${beam} ${ray.number} ${ray.lambda_nm} ${one.index}`,
        segment,
        hit: one.node.hit,
        x: port.x(u),
        y: port.y(v),
        weight: one.weight,
        aside: isAside(port, plane, segment),
      };
    })
    .filter(({ x, y }) => x >= 0 && y >= 0 && x <= port.width && y <= port.height)
    .sort((a, b) => b.weight - a.weight);
}

const degrees = (angle) => `${digits(angle, 4)}°`;
const tenths = (angle) => `${digits(Math.round(10 * angle) / 10, 4)}°`;

export function hitName({ hit, segment }) {
  const incidence = degrees(hit.snell.incidence_deg);
  const about = { beam: segment.beam, solid: hit.solid, incidence, refraction: degrees(hit.snell.refraction_deg) };
  if (hit.opaque) return say('{beam} meets {solid}: angle of incidence {incidence}, reflected or absorbed', about);
  about.media = `n₁ = ${digits(hit.from.n, 5)}, n₂ = ${digits(hit.to.n, 5)}`;
  return hit.tir
    ? say('{beam} meets {solid}: angle of incidence {incidence}, total reflection, {media}', about)
    : say('{beam} meets {solid}: angle of incidence {incidence}, of refraction {refraction}, {media}', about);
}

/* --- normal, arcs and labels --- */

const NORMAL_PX = 58;
const ARC_PX = [30, 38]; /* of incidence and of refraction */
const LABEL_PX = 15; /* from an arc to its label's centre */

const unitOf = ([x, y]) => {
  const size = Math.hypot(x, y);
  return size > 1e-9 ? [x / size, y / size] : null;
};

const onScreen = ({ right, up }, vector) => unitOf([dot(vector, right), -dot(vector, up)]);

function arc(hit, from, to, radius) {
  const [a, b] = [from, to].map(([x, y]) => [hit.x + radius * x, hit.y + radius * y]);
  const sweep = from[0] * to[1] - from[1] * to[0] > 0 ? 1 : 0;
  return svg('path', {
    class: 'section-arc',
    d: `M${a.map(round)}A${radius} ${radius} 0 0 ${sweep} ${b.map(round)}`,
  });
}

/* A label with a plate, in a direction from the hit; empty if it would cover another one. */
function label(hit, direction, away, text, name, { full, room }) {
  const width = 8 + 6.8 * text.length;
  const [x, y] = [hit.x + direction[0] * (away + width / 2 - 8), hit.y + direction[1] * (away + 4)];
  const box = [x - width / 2, y - 9, x + width / 2, y + 9];
  const covers = ([left, top, right, bottom]) => box[0] < right && box[2] > left && box[1] < bottom && box[3] > top;
  if (!full && room.some(covers)) return [];
  room.push(box);
  return [
    svg('rect', { class: 'section-plate', x: box[0], y: box[1], width, height: 18, rx: 4 }),
    svg('text', { class: `section-angle ${name}`, x, y: y + 4, 'text-anchor': 'middle' }, text),
  ];
}

export function hitMarks(port, plane, mark, options) {
  const { hit, segment } = mark;
  const { full, room } = options;
  const before = room.length;
  const normal = onScreen(plane, hit.normal);
  const incoming = onScreen(plane, segment.line.along);
  if (!normal || !incoming) return [];
  const back = [-incoming[0], -incoming[1]];
  const inside = [-normal[0], -normal[1]];
  const [x1, y1, x2, y2] = [normal, inside].flatMap(([x, y]) => [mark.x + NORMAL_PX * x, mark.y + NORMAL_PX * y]);
  const middle = (a, b) => unitOf([a[0] + b[0], a[1] + b[1]]) || a;
  const line = svg('path', { class: 'section-normal', d: `M${round(x1)} ${round(y1)}L${round(x2)} ${round(y2)}` });
  if (options.bare) return [line];
  const marks = [
    line,
    arc(mark, normal, back, ARC_PX[0]),
    ...label(
      mark,
      middle(normal, back),
      ARC_PX[0] + LABEL_PX,
      full ? `i = ${degrees(hit.snell.incidence_deg)}` : tenths(hit.snell.incidence_deg),
      'incidence',
      options,
    ),
  ];
  const refracted = segment.one.children.find(({ node }) => node.kind === 'refract');
  const onwards = refracted && onScreen(plane, refracted.line.along);
  if (onwards)
    marks.push(
      arc(mark, inside, onwards, ARC_PX[1]),
      ...label(
        mark,
        middle(inside, onwards),
        ARC_PX[1] + LABEL_PX,
        full ? `r = ${degrees(hit.snell.refraction_deg)}` : tenths(hit.snell.refraction_deg),
        'refraction',
        options,
      ),
    );
  else if (hit.tir) marks.push(...label(mark, inside, 30, say('total reflection'), 'refraction', options));
  if (full && !hit.opaque) marks.push(...indices(mark, normal, incoming, options));
  /* Arcs without a number say nothing. */
  const complete = full || room.length - before === (onwards || hit.tir ? 2 : 1);
  if (!complete) room.length = before;
  return complete ? marks : [];
}

/* On the sides of the normal where the incoming and the refracted ray are not. */
function indices(mark, normal, incoming, options) {
  const across = [-normal[1], normal[0]];
  const side = across[0] * incoming[0] + across[1] * incoming[1] > 0 ? 1 : -1;
  const between = (sign) => unitOf(normal.map((x, axis) => sign * (x + side * across[axis])));
  return [
    ...label(mark, between(1), 40, `n₁ = ${digits(mark.hit.from.n, 5)}`, 'index', options),
    ...label(mark, between(-1), 40, `n₂ = ${digits(mark.hit.to.n, 5)}`, 'index', options),
  ];
}
