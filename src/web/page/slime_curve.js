/* A small chart of the slime's volume relative to its volume at rest, over the last seconds of its motion.
 * exports: createCurve() -> {node, add(slime), clear()} */

import { digits, element, svg } from './ui.js';

const WIDTH = 320;
const HEIGHT = 84;
const LEFT = 44;
const LONG_S = 10;
const LEAST = 0.02; /* minimum half range of the chart, as a share of the volume at rest */

const xOf = (time, now) => LEFT + (WIDTH - LEFT) * (1 - (now - time) / LONG_S);

export function createCurve() {
  const line = svg('path', { class: 'curve-line' });
  const rest = svg('line', { class: 'curve-rest', x1: LEFT, x2: WIDTH });
  const labels = [
    svg('text', { x: LEFT - 6, 'text-anchor': 'end' }),
    svg('text', { x: LEFT - 6, 'text-anchor': 'end' }),
    svg('text', { x: LEFT - 6, 'text-anchor': 'end' }),
  ];
  const drawing = svg(
    'svg',
    { class: 'slime-curve', viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: 'img', 'aria-label': 'Volume' },
    rest,
    line,
    labels,
  );
  const node = element(
    'figure',
    { class: 'slime-figure' },
    drawing,
    element('figcaption', { class: 'hint', text: `Volume in % of the volume at rest (dashed), last ${LONG_S} s` }),
  );
  let points = [];
  let frame = 0;
  draw();
  return { node, add, clear };

  function clear() {
    points = [];
    frame ||= requestAnimationFrame(draw);
  }

  function add(slime) {
    const last = points[points.length - 1];
    if (!(slime.volume > 0 && slime.volume_at_rest > 0)) return;
    if (last && slime.time_s < last.time) points = [];
    if (last && slime.time_s === last.time) return;
    points.push({ time: slime.time_s, share: slime.volume / slime.volume_at_rest });
    while (points.length && points[0].time < slime.time_s - LONG_S) points.shift();
    frame ||= requestAnimationFrame(draw);
  }

  function draw() {
    frame = 0;
    const away = Math.max(LEAST, ...points.map((point) => Math.abs(point.share - 1)));
    const middle = HEIGHT / 2;
    const yOf = (share) => middle - ((share - 1) / away) * (middle - 10);
    const now = points.length ? points[points.length - 1].time : 0;
    line.setAttribute(
      'd',
      points
        .map((point, index) => `${index ? 'L' : 'M'}${xOf(point.time, now).toFixed(1)} ${yOf(point.share).toFixed(1)}`)
        .join(''),
    );
    rest.setAttribute('y1', middle);
    rest.setAttribute('y2', middle);
    for (const [index, share] of [1 + away, 1, 1 - away].entries()) {
      labels[index].textContent = digits(100 * share, away < 0.05 ? 4 : 3);
      labels[index].setAttribute('y', yOf(share) + 4);
    }
    drawing.setAttribute(
      'aria-label',
      points.length
        ? `Volume ${digits(100 * points[points.length - 1].share, 4)} % of the volume at rest`
        : 'Volume: no motion yet',
    );
  }
}
