/* What a section draws around the solids and rays: the grid with its numbers, the legend of the media, the scale.
 * exports:
 *   gridSteps(port) -> {minor, major}         scene units; the pointer snaps to minor
 *   gridMarks(port, plane, steps) -> {lines, labels}    SVG elements, under and over the solids
 *   legendMarks(port, areas) -> elements; legendRoom(port, areas) -> pixels that a narrow window keeps free for them
 *   lightMarks(lab, port, plane) -> elements  of the lights in the window, and arrows to those outside
 *   scaleMarks(port, unitM) -> elements
 *   mediumFill(area) -> a CSS colour */

import { say } from '../shared/language.js';
import { digits, svg } from '../shared/ui.js';
import { axisName, flat, niceStep } from './section_plane.js';

const MINOR_PX = 14;
const MAJOR_PX = 72;
const EDGE = 4;
const ROW = 18;
const LETTER = 6.6; /* average width of a letter of 12 px */

export function gridSteps({ scale }) {
  const major = niceStep(MAJOR_PX / scale);
  const parts = [10, 5, 4, 2].find((count) => (major / count) * scale >= MINOR_PX) || 1;
  /* Of 2 and 20, a quarter is a good number; of 1 and 5 it is not. */
  const first = Number((major / 10 ** Math.floor(Math.log10(major) + 1e-9)).toPrecision(3));
  return { major, minor: major / (parts === 4 && first !== 2 ? 2 : parts) };
}

const values = (low, high, step) => {
  const first = Math.ceil(low / step - 1e-9);
  const count = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: Math.max(0, Math.min(count, 500)) }, (_, k) =>
    Number(((first + k) * step).toPrecision(12)),
  );
};

export function gridMarks(port, { right, up }, { major, minor }) {
  const [u0, u1, v0, v1] = port.extent();
  const path = (name, step) => {
    const across = values(u0, u1, step).map((u) => `M${port.x(u).toFixed(1)} 0V${port.height}`);
    const along = values(v0, v1, step).map((v) => `M0 ${port.y(v).toFixed(1)}H${port.width}`);
    return svg('path', { class: name, d: [...across, ...along].join('') });
  };
  const zero = `M${port.x(0).toFixed(1)} 0V${port.height}M0 ${port.y(0).toFixed(1)}H${port.width}`;
  const text = (x, y, anchor, words) => svg('text', { class: 'section-tick', x, y, 'text-anchor': anchor }, words);
  const bottom = port.height - EDGE;
  const labels = [
    ...values(u0, u1, major)
      .filter((u) => port.x(u) > 34 && port.x(u) < port.width - 40)
      .map((u) => text(port.x(u), bottom, 'middle', digits(u, 6))),
    ...values(v0, v1, major)
      .filter((v) => port.y(v) > 30 && port.y(v) < port.height - 24)
      .map((v) => text(EDGE, port.y(v) + 4, 'start', digits(v, 6))),
    text(port.width - 8, bottom, 'end', `${axisName(right) || 'along'} →`),
    text(EDGE, 16, 'start', `${axisName(up) || 'across'} ↑`),
  ];
  return {
    lines: [
      path('section-minor', minor),
      path('section-major', major),
      svg('path', { class: 'section-zero', d: zero }),
    ],
    labels,
  };
}

const LAMP = 9;

/* A lamp where a light is in the window, also if it is above or below the plane; at the edge, if it is outside. */
export function lightMarks(lab, port, plane) {
  const lights = (lab.scene?.objects || []).filter(({ kind }) => kind === 'light');
  return lights.flatMap(({ name }) => {
    const place = lab.param(`${name}.position`)?.value;
    if (!place) return [];
    const [u, v, away] = flat(plane, place);
    const inside = (x, low, high) => Math.min(high, Math.max(low, x));
    const [x, y] = [inside(port.x(u), 30, port.width - 30), inside(port.y(v), 30, port.height - 44)];
    const outside = Math.hypot(x - port.x(u), y - port.y(v)) > 1;
    const where = outside ? say('{name}, outside the window', { name }) : name;
    const depth = Math.abs(away) * port.scale > 1 ? say('{name}, not in this plane', { name }) : where;
    const rays = [0, 45, 90, 135, 180, 225, 270, 315].map((angle) => {
      const [cos, sin] = [Math.cos((angle * Math.PI) / 180), Math.sin((angle * Math.PI) / 180)];
      return `M${x + 7 * cos} ${y + 7 * sin}L${x + LAMP * 1.25 * cos} ${y + LAMP * 1.25 * sin}`;
    });
    return [
      svg(
        'g',
        { class: `section-light${outside ? ' outside' : ''}` },
        svg('title', {}, outside ? where : depth),
        svg('circle', { cx: x, cy: y, r: 4.5 }),
        svg('path', { d: rays.join('') }),
        svg('text', { class: 'section-tick', x, y: y + 24, 'text-anchor': 'middle' }, name),
      ),
    ];
  });
}

/* The scale bar: a round length with the length in metres that the scene gives it. */
export function scaleMarks(port, unitM) {
  const length = niceStep(60 / port.scale);
  const [x1, y] = [port.width - 14, port.height - 34];
  const x0 = x1 - length * port.scale;
  return [
    svg('path', { class: 'section-scale', d: `M${x0} ${y - 5}V${y}H${x1}V${y - 5}` }),
    svg(
      'text',
      { class: 'section-tick', x: x1, y: y - 9, 'text-anchor': 'end' },
      length === 1
        ? say('1 unit = {length}', { length: inMetres(unitM) })
        : say('{units} units = {length}', { units: digits(length), length: inMetres(length * unitM) }),
    ),
  ];
}

function inMetres(length) {
  const [unit, factor] = [
    ['km', 1e3],
    ['m', 1],
    ['cm', 1e-2],
    ['mm', 1e-3],
    ['µm', 1e-6],
    ['nm', 1e-9],
  ].find(([, size]) => length >= size * (1 - 1e-9)) || ['nm', 1e-9];
  return `${digits(length / factor)} ${unit}`;
}

/* Transparent media from pale blue (n near 1) over blue to violet; those below the index of a vacuum are orange. */
export function mediumFill({ opaque, n, color }) {
  if (opaque) return `rgb(${color.map((x) => Math.round(255 * (0.25 + 0.6 * x))).join(' ')} / 75%)`;
  if (n < 1 - 1e-9) return 'hsl(30 85% 55% / 35%)';
  const strength = Math.min(1, Math.max(0, n - 1) / 1.2);
  return `hsl(${Math.round(198 + 72 * strength)} 75% 55% / ${Math.round(8 + 46 * Math.sqrt(strength))}%)`;
}

const shortened = (text, most) => (text.length > most ? `${text.slice(0, most - 1)}…` : text);

const NARROW = 600;

export function legendRoom(port, areas) {
  if (port.width >= NARROW) return 0;
  const rows = new Set(areas.map((area) => (area.opaque ? area.solid : `${area.medium} ${area.n}`))).size;
  return 24 + ROW * Math.min(4, Math.max(1, rows));
}

/* One row for each medium, with the names of its solids; opaque solids have one row each. */
export function legendMarks(port, areas) {
  const rows = new Map();
  for (const area of [...areas].sort((a, b) => (a.n ?? Infinity) - (b.n ?? Infinity))) {
    const key = area.opaque ? area.solid : `${area.medium} ${area.n}`;
    if (!rows.has(key)) rows.set(key, { area, names: [] });
    rows.get(key).names.push(area.solid);
  }
  const room = port.width < NARROW ? 4 : 8;
  const shown = [...rows.values()].slice(0, rows.size > room ? room - 1 : room);
  const lines = shown.map(({ area, names }) => {
    const solids = names.join(', ');
    if (area.opaque) return [area, say('{solids}: opaque', { solids })];
    const medium = `${area.medium}, n = ${digits(area.n, 5)}`;
    return [area, names.length === 1 && area.medium === solids ? medium : `${solids}: ${medium}`];
  });
  if (rows.size > shown.length) lines.push([null, say('and {n} more media', { n: rows.size - shown.length })]);
  if (!lines.length) return [];
  const most = Math.max(16, Math.floor((port.width - 110) / LETTER));
  const texts = lines.map(([area, text]) => [area, shortened(text, Math.min(most, 60))]);
  const width = 44 + LETTER * Math.max(...texts.map(([, text]) => text.length));
  const [left, top] = [port.width - width - 8, 8];
  return [
    svg('rect', { class: 'section-plate', x: left, y: top, width, height: ROW * texts.length + 8, rx: 6 }),
    ...texts.flatMap(([area, text], k) => {
      const y = top + 4 + ROW * k;
      const swatch = area && svg('rect', { class: 'section-swatch', x: left + 8, y: y + 4, width: 20, height: 11 });
      swatch?.style.setProperty('fill', mediumFill(area));
      return [swatch, svg('text', { class: 'section-legend', x: left + 35, y: y + 14 }, text)].filter(Boolean);
    }),
  ];
}
