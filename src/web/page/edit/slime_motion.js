/* The motion of a slime: the curve of its volume, and a comparison with closed-form mechanics.
 * exports:
 *   createCurve() -> {node, add(slime), clear()}     the volume relative to that at rest, over the last seconds
 *   createMotion(lab) -> {node}                      what `cuvette motion` prints */

import { say } from '../shared/language.js';
import { createRenewal } from '../shared/renewal.js';
import { button, digits, download, element, notice, replace, svg, table } from '../shared/ui.js';

const WIDTH = 320;
const HEIGHT = 84;
const LEFT = 44;
const LONG_S = 10;
const LEAST = 0.02; /* minimum half range of the chart, as a fraction of the volume at rest */

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
    element('figcaption', {
      class: 'hint',
      text: say('Volume in % of the volume at rest (dashed), last {time} s', { time: LONG_S }),
    }),
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
    points.push({ time: slime.time_s, fraction: slime.volume / slime.volume_at_rest });
    while (points.length && points[0].time < slime.time_s - LONG_S) points.shift();
    frame ||= requestAnimationFrame(draw);
  }

  function draw() {
    frame = 0;
    const away = Math.max(LEAST, ...points.map((point) => Math.abs(point.fraction - 1)));
    const middle = HEIGHT / 2;
    const yOf = (fraction) => middle - ((fraction - 1) / away) * (middle - 10);
    const now = points.length ? points[points.length - 1].time : 0;
    line.setAttribute(
      'd',
      points
        .map(({ time, fraction }, i) => `${i ? 'L' : 'M'}${xOf(time, now).toFixed(1)} ${yOf(fraction).toFixed(1)}`)
        .join(''),
    );
    rest.setAttribute('y1', middle);
    rest.setAttribute('y2', middle);
    for (const [index, fraction] of [1 + away, 1, 1 - away].entries()) {
      labels[index].textContent = digits(100 * fraction, away < 0.05 ? 4 : 3);
      labels[index].setAttribute('y', yOf(fraction) + 4);
    }
    drawing.setAttribute(
      'aria-label',
      points.length
        ? say('Volume {percent} % of the volume at rest', {
            percent: digits(100 * points[points.length - 1].fraction, 4),
          })
        : say('Volume: no motion yet'),
    );
  }
}

function shown({ name, level, integrator, dt_s: step, values }) {
  return table({
    caption: say('{name}: level {level}, {integrator}, steps of {step} s', {
      name,
      level,
      integrator,
      step: digits(step),
    }),
    columns: [
      'Property',
      { label: 'Measured', numeric: true },
      { label: 'Theory', numeric: true },
      { label: 'Error', numeric: true },
    ],
    rows: values.map(({ name: property, unit, what, measured, theory, error }) => [
      element('span', { title: `${what}${unit ? `, ${unit}` : ''}`, text: property }),
      digits(measured, 6),
      digits(theory, 6),
      digits(error, 2),
    ]),
  });
}

export function createMotion(lab) {
  const result = element('div', { class: 'slime-motion', 'aria-live': 'polite' });
  const renewal = createRenewal(lab, result, act);
  const measure = button('Measure', renewal.run, { icon: 'ruler', small: true, kind: 'primary' });
  const stop = button('Stop', () => lab.post('/api/motion/stop', {}).catch(lab.fail), { icon: 'stop', small: true });
  const node = element(
    'div',
    { class: 'slime-motion' },
    element('p', {
      class: 'hint',
      text:
        'Springs, falls and free bodies with the stiffness, integrator and time step of the slime, without hands. ' +
        'About 2 s at level 4, four times as long for each further level, five times with the integrator implicit; ' +
        'at most 50 s.',
    }),
    element('div', { class: 'buttons' }, measure, stop),
    renewal.node,
    result,
  );
  stop.disabled = true;
  stop.hidden = lab.engine.kind === 'browser'; /* the worker's one thread handles a stop only after the measurement */
  return { node };

  async function act() {
    measure.disabled = true;
    stop.disabled = false;
    replace(result, element('p', { class: 'hint', text: 'Measuring …' }));
    try {
      const { slimes, csv } = await lab.get('/api/motion');
      replace(result, slimes.map(shown), save(csv));
      return true;
    } catch (error) {
      replace(result, notice(error.message, { kind: 'error', remedy: error.remedy }));
      return false;
    } finally {
      measure.disabled = false;
      stop.disabled = true;
    }
  }

  function save(csv) {
    const name = `${lab.name()}-motion.csv`;
    return button('Save table', () => download(new Blob([csv], { type: 'text/csv' }), name), {
      icon: 'download',
      small: true,
    });
  }
}
