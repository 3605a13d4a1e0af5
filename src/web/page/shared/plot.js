/* A line chart with intervals over one axis; series differ by colour, marker and dash.
 *
 * exports: plot({title, x, y, series, heading, mark, marks, spots, circles, width, height, legends}) -> SVG element
 *   x: {label, log, values, ends}       values: words of a categorical axis; points are then at 0, 1, 2 ..
 *   y: {label, log, ends}               ends: [from, to] of the axis, instead of those of the points
 *   series: [{name, points: [{x, y, low, high}], shape, colour, dash, marked, joined}]      low and high NaN: no
 *     interval is known; shape: 'dots', or 'bars' from 0 next to each other; colour and dash: numbers from 0, instead
 *     of the place in the list; marked or joined false: without markers or without the line
 *   width, height: of the drawing in its own units; legends false: none
 *   heading: title of the legend, the parameters in which the series differ
 *   mark: a value of y with a horizontal line, such as 1 for ratios
 *   marks: [{axis: 'x' or 'y', at, text, kind}] labelled lines; one beyond the axis is at its end, with an arrow
 *   spots: [{x, y, text}] points with a ring
 *   circles: [{x, y, r, text}] with a radius of the x axis
 *
 * If curves have intervals at the same x, these curves are shifted sideways by a few units of the drawing, so that the
 * intervals do not hide each other. */

import { digits, svg, unique } from './ui.js';

const WIDTH = 860;
const HEIGHT = 400;
const FRAME = { left: 76, top: 34, right: 22, bottom: 48 };
const WORDS = 30; /* height of slanted words below the axis */
const LEGEND = 226;
const NAME_MAX = 23; /* characters that fit into the legend's width */
const TICKS = 6; /* about the largest number of ticks */
const APART_X = 40; /* distances of ticks in small drawings */
const APART_Y = 26;
const BARS = 0.8; /* part of a category that its bars fill */
const COLOURS = 5;
const SHIFT = 7; /* distance of a curve from the next */
const SHIFTS = 28; /* about the largest distance of the last curve from the first */
const DASHES = ['', '7 4', '2 3', '9 3 2 3', '4 2'];
const MARKERS = [
  'M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0',
  'M-3.600-3.600h7.200v7.200h-7.200z',
  'M0-5 4.600 3.600h-9.200z',
  'M0-5 5 0 0 5-5 0z',
  'M0 5-4.600-3.600h9.200z',
  'M-4-4 4 4M4-4-4 4',
  'M-5 0h10M0-5v10',
];

const round = (value) => Math.round(value * 100) / 100;
const finite = (values) => values.filter((value) => Number.isFinite(value));

/* Maps values to positions between two ends of the drawing. */
function ruler({ log, from, to, a, b }) {
  const bend = log ? Math.log10 : (value) => value;
  const [low, high] = [bend(from), bend(to)];
  const ticks = Math.max(2, Math.min(TICKS, b > a ? (b - a) / APART_X : (a - b) / APART_Y));
  return { log, from, to, ticks, at: (value) => round(a + ((bend(value) - low) / (high - low)) * (b - a)) };
}

function niceStep(across, ticks) {
  const power = 10 ** Math.floor(Math.log10(across / ticks));
  const times = across / ticks / power;
  return power * (times > 5 ? 10 : times > 2 ? 5 : times > 1 ? 2 : 1);
}

function linearTicks({ from, to, ticks }) {
  const step = niceStep(to - from, ticks);
  const first = Math.ceil(from / step - 1e-9);
  const last = Math.floor(to / step + 1e-9);
  return Array.from({ length: last - first + 1 }, (_, k) => Number(((first + k) * step).toPrecision(12)));
}

function logTicks(from, to) {
  const decades = Math.log10(to / from);
  const times = decades < 1.5 ? [1, 2, 3, 5, 7] : decades < 3.5 ? [1, 2, 5] : [1];
  const all = [];
  for (let power = Math.floor(Math.log10(from)); power <= Math.ceil(Math.log10(to)); power++) {
    for (const time of times) all.push(Number((time * 10 ** power).toPrecision(6)));
  }
  return all.filter((value) => value >= from * 0.999 && value <= to * 1.001);
}

/* The ends of an axis: slightly beyond the values; a linear axis starts at 0 if that is close. */
function ends(values, log, wide) {
  let [from, to] = [Math.min(...values), Math.max(...values)];
  if (log) {
    const more = from === to ? 2 : (to / from) ** 0.06;
    return [from / more, to * more];
  }
  if (wide && from > 0 && from < 0.6 * to) from = 0;
  if (from === to) [from, to] = [from - Math.abs(from || 1) / 2, to + Math.abs(to || 1) / 2];
  const more = (to - from) * 0.05;
  return [from === 0 && wide ? 0 : from - more, to + more];
}

/* On a logarithmic axis with few values, each value is a better tick than powers of ten. */
function ticksOf(scale, values) {
  if (!scale.log) return linearTicks(scale);
  const apart = values?.every((value, i) => i === 0 || Math.abs(scale.at(value) - scale.at(values[i - 1])) > 34);
  return values && values.length <= 12 && apart ? values : logTicks(scale.from, scale.to);
}

const text = (x, y, anchor, words, more) => svg('text', { x, y, 'text-anchor': anchor, ...more }, words);

/* Words under the axis are slanted if they do not fit next to each other. */
const areSlanted = (values, width) =>
  values && Math.max(...values.map((value) => value.length)) * 6.5 > width / values.length;

function words(values, scale, bottom, slanted) {
  const short = (value) => (slanted && value.length > 14 ? `${value.slice(0, 13)}…` : value);
  return values.map((value, i) => {
    const x = scale.at(i);
    const turn = slanted ? { transform: `rotate(-28 ${x} ${bottom + 14})` } : {};
    return text(x + (slanted ? 4 : 0), bottom + 16, slanted ? 'end' : 'middle', short(value), turn);
  });
}

function axes(area, x, y, across, up) {
  const xValues = [...new Set(finite(x.points))].sort((a, b) => a - b);
  const right = area.x + area.width;
  const bottom = area.y + area.height;
  return svg(
    'g',
    { class: 'plot-axes' },
    ticksOf(up).map((value) => [
      svg('path', { class: 'plot-grid', d: `M${area.x} ${up.at(value)}H${right}` }),
      text(area.x - 7, up.at(value) + 4, 'end', digits(value)),
    ]),
    x.values
      ? words(x.values, across, bottom, areSlanted(x.values, area.width))
      : ticksOf(across, xValues).map((value) => [
          svg('path', { class: 'plot-grid', d: `M${across.at(value)} ${area.y}V${bottom}` }),
          text(across.at(value), bottom + 16, 'middle', digits(value)),
        ]),
    svg('path', { class: 'plot-frame', d: `M${area.x} ${area.y}V${bottom}H${right}` }),
    text(area.x + area.width / 2, area.end - 8, 'middle', x.label, { class: 'plot-label' }),
    text(0, 0, 'middle', y.label, {
      class: 'plot-label',
      transform: `translate(15 ${area.y + area.height / 2}) rotate(-90)`,
    }),
  );
}

const styleOf = ({ colour }, index) => ({ class: `plot-series plot-colour-${((colour ?? index) % COLOURS) + 1}` });
const dashOf = ({ dash }, index) => DASHES[(dash ?? index) % DASHES.length];

const hasInterval = (point) => point.low < point.high;

/* How far each curve is shifted sideways. */
function shiftsOf(series) {
  const withIntervals = series.filter((one) => one.points.some(hasInterval));
  const xs = withIntervals.map((one) => one.points.filter(hasInterval).map((point) => point.x));
  const shared = xs.some((some, i) => xs.slice(0, i).some((other) => some.some((x) => other.includes(x))));
  const step = Math.min(SHIFT, SHIFTS / withIntervals.length);
  return series.map((one) =>
    shared && withIntervals.includes(one)
      ? round((withIntervals.indexOf(one) - (withIntervals.length - 1) / 2) * step)
      : 0,
  );
}

function line(one, index, across, up, shift) {
  const points = one.points.filter(
    (point) =>
      Number.isFinite(point.x) && Number.isFinite(point.y) && (!up.log || point.y > 0) && (!across.log || point.x > 0),
  );
  const place = ({ x }) => round(across.at(x) + shift);
  const at = points.map((point) => `${place(point)} ${up.at(point.y)}`);
  return svg(
    'g',
    styleOf(one, index),
    at.length > 1 && one.joined !== false
      ? svg('path', { class: 'plot-line', d: `M${at.join('L')}`, 'stroke-dasharray': dashOf(one, index) })
      : null,
    points
      .filter((point) => hasInterval(point) && (!up.log || point.low > 0))
      .map((point) =>
        svg('path', {
          class: 'plot-interval',
          d: `M${place(point) - 4} ${up.at(point.low)}h8m-4 0V${up.at(point.high)}m-4 0h8`,
        }),
      ),
    (one.marked === false ? [] : points).map((point, i) =>
      svg(
        'path',
        { class: 'plot-marker', d: MARKERS[index % MARKERS.length], transform: `translate(${at[i]})` },
        svg('title', {}, `${one.name ? `${one.name}: ` : ''}${digits(point.y, 5)}`),
      ),
    ),
  );
}

const dots = (one, index, across, up) =>
  svg(
    'g',
    styleOf(one, index),
    svg('path', { class: 'plot-dots', d: one.points.map(({ x, y }) => `M${across.at(x)} ${up.at(y)}h0`).join('') }),
  );

function bars(one, index, count, across, up) {
  const wide = round(((across.at(1) - across.at(0)) * BARS) / count);
  const zero = up.at(0);
  return svg(
    'g',
    styleOf(one, index),
    finite(one.points.map((point) => point.y)).length
      ? one.points.map(({ x, y }) =>
          svg(
            'path',
            {
              class: 'plot-bar',
              d: `M${round(across.at(x) + (index - count / 2) * wide)} ${zero}V${up.at(y)}h${wide}V${zero}`,
            },
            svg('title', {}, `${one.name}: ${digits(y, 5)}`),
          ),
        )
      : null,
  );
}

function drawn(one, index, { series, across, up, shift }) {
  if (one.shape === 'dots') return dots(one, index, across, up);
  if (one.shape === 'bars') return bars(one, index, series.length, across, up);
  return line(one, index, across, up, shift);
}

const rounds = (circles, across, up) =>
  circles.map(({ x, y, r, text: words }) =>
    svg(
      'circle',
      { class: 'plot-circle', cx: across.at(x), cy: up.at(y), r: round(across.at(r) - across.at(0)) },
      svg('title', {}, words),
    ),
  );

/* Texts of vertical lines are at the top, each lower than the last; texts of horizontal lines are at the right. */
function lines(marks, area, across, up) {
  const inside = (scale, at) => Math.min(Math.max(at, scale.from), scale.to);
  let down = 0;
  return marks.map(({ axis, at, text: words, kind }) => {
    const [scale, arrows] = axis === 'x' ? [across, '←→'] : [up, '↓↑'];
    const arrow = at < scale.from ? `${arrows[0]} ` : at > scale.to ? `${arrows[1]} ` : '';
    const to = scale.at(inside(scale, at));
    const right = to > area.x + area.width / 2;
    down += axis === 'x' ? 16 : 0;
    return svg(
      'g',
      { class: `plot-line-mark plot-${kind}` },
      svg('path', { d: axis === 'x' ? `M${to} ${area.y}v${area.height}` : `M${area.x} ${to}h${area.width}` }),
      axis === 'x'
        ? text(to + (right ? -5 : 5), area.y + down - 4, right ? 'end' : 'start', arrow + words)
        : text(area.x + area.width - 4, to + (to < area.y + 20 ? 15 : -5), 'end', arrow + words),
    );
  });
}

const rings = (spots, across, up) =>
  spots.map(({ x, y, text: words }) =>
    svg('circle', { class: 'plot-spot', cx: across.at(x), cy: up.at(y), r: 8 }, svg('title', {}, words)),
  );

function legend(series, heading, left) {
  const short = (name) => (name.length > NAME_MAX ? `${name.slice(0, NAME_MAX - 1)}…` : name);
  return svg(
    'g',
    { class: 'plot-legend' },
    text(left, FRAME.top + 4, 'start', short(heading), { class: 'plot-label' }),
    series.map((one, index) => {
      const y = FRAME.top + 26 + index * 20;
      return svg(
        'g',
        styleOf(one, index),
        svg('path', { class: 'plot-line', d: `M${left} ${y}h34`, 'stroke-dasharray': dashOf(one, index) }),
        svg('path', {
          class: 'plot-marker',
          d: MARKERS[index % MARKERS.length],
          transform: `translate(${left + 17} ${y})`,
        }),
        text(left + 44, y + 4, 'start', short(one.name)),
        svg('title', {}, one.name),
      );
    }),
  );
}

export function plot({ title, x, y, series, heading = '', mark, marks = [], spots = [], ...more }) {
  const { width: outer = WIDTH, height: end = HEIGHT, legends = true, circles = [] } = more;
  const many = legends && series.length > 1;
  const width = outer - FRAME.left - FRAME.right - (many ? LEGEND : 0);
  const area = {
    x: FRAME.left,
    y: FRAME.top,
    width,
    height: end - FRAME.top - FRAME.bottom - (areSlanted(x.values, width) ? WORDS : 0),
    end,
  };
  const points = series.flatMap((one) => one.points);
  const xs = points.map((point) => point.x);
  const ys = finite([...points.flatMap((point) => [point.y, point.low, point.high]), mark]).filter(
    (value) => !y.log || value > 0,
  );
  const [left, right] = x.values ? [-0.5, x.values.length - 0.5] : (x.ends ?? ends(finite(xs), x.log, false));
  const [low, high] = y.ends ?? ends(ys, y.log, mark === undefined);
  const across = ruler({ log: x.log && !x.values, from: left, to: right, a: area.x, b: area.x + area.width });
  const up = ruler({ log: y.log, from: low, to: high, a: area.y + area.height, b: area.y });
  const shifts = shiftsOf(series);
  const name = unique('plot');
  return svg(
    'svg',
    { class: 'plot', viewBox: `0 0 ${outer} ${end}`, role: 'img', 'aria-labelledby': name },
    svg('title', { id: name }, title),
    text(area.x, 17, 'start', title, { class: 'plot-title', 'aria-hidden': 'true' }),
    axes(area, { ...x, points: xs }, y, across, up),
    mark === undefined ? null : svg('path', { class: 'plot-mark', d: `M${area.x} ${up.at(mark)}h${area.width}` }),
    lines(marks, area, across, up),
    series.map((one, index) => drawn(one, index, { series, across, up, shift: shifts[index] })),
    rounds(circles, across, up),
    rings(spots, across, up),
    many ? legend(series, heading, area.x + area.width + 24) : null,
  );
}
