/* A curve of the optics: measured points over the line of theory; in a lesson also the present value of the control on
 * the x axis and the prediction; and a table of the points for screen readers.
 * exports: theoryChart(lesson, result, {now, predicted}) -> node; pretty(text), an axis label with its unit as the page
 * writes it
 *   now: the present value of measure.x_parameter, NaN if there is none; predicted: as typed or chosen, or null */

import { say, translated } from './language.js';
import { plot } from './plot.js';
import { digits, element, table } from './ui.js';

const MARKS = 30; /* more would hide the line */

let unfolded = false; /* a new measurement leaves the table open */

/* Replaces a unit in ASCII, as on the command line, by the page's spelling. */
export function pretty(text) {
  const [, name, unit] = /^(.*?)(?:, (deg|px|nm|m|s|scene units))?$/.exec(text);
  if (!unit) return translated(name);
  return `${translated(name)} (${unit === 'deg' ? '°' : translated(unit)})`;
}

/* The number of a prediction: as typed, or the only number in the text of the choice; otherwise NaN. */
function numberIn(predicted) {
  if (typeof predicted === 'number') return predicted;
  const all = String(predicted ?? '').match(/[-\u2212]?\d+([.,]\d+)?/g) || [];
  return all.length === 1 ? Number(all[0].replace(',', '.').replace('\u2212', '-')) : NaN;
}

function marksOf({ prediction }, now, predicted) {
  const guess = numberIn(predicted);
  return [
    Number.isFinite(now)
      ? { axis: 'x', at: now, text: say('now: {value}', { value: digits(now) }), kind: 'now' }
      : null,
    prediction?.axis && Number.isFinite(guess)
      ? {
          axis: prediction.axis,
          at: guess,
          text: say('your prediction: {value}', { value: digits(guess) }),
          kind: 'predicted',
        }
      : null,
  ].filter(Boolean);
}

/* The value that the lesson reads, if it is a point of the curve. */
function spotsOf({ measure }, { points, measured }, now) {
  const near = (at) => points.reduce((a, b) => (Math.abs(b[0] - at) < Math.abs(a[0] - at) ? b : a));
  const x = Number.isFinite(measure.at) ? near(measure.at)[0] : measure.over ? now : NaN;
  return Number.isFinite(x) && Number.isFinite(measured)
    ? [{ x, y: measured, text: `${translated(measure.reading)}: ${digits(measured, 6)}` }]
    : [];
}

export function theoryChart(lesson, result, { now = NaN, predicted = null } = {}) {
  const { points } = result;
  const sparse = Math.max(1, Math.ceil(points.length / MARKS));
  const drawn = points.filter((_, i) => i % sparse === 0 || i === points.length - 1);
  const { x, y, timed } = lesson.measure;
  return element(
    'figure',
    { class: 'theory-chart' },
    plot({
      title: lesson.title,
      width: 560,
      legends: false,
      x: { label: pretty(x) },
      y: { label: pretty(y) },
      marks: marksOf(lesson, now, predicted),
      spots: spotsOf(lesson, result, now),
      series: [
        { name: 'theory', marked: false, points: points.map(([at, , theory]) => ({ x: at, y: theory })) },
        { name: 'measured', joined: false, points: drawn.map(([at, measured]) => ({ x: at, y: measured })) },
      ],
    }),
    element(
      'figcaption',
      { class: 'hint' },
      element('span', { class: 'theory-key theory', text: timed ? 'theory: ideal' : 'theory: closed form' }),
      element('span', {
        class: 'theory-key measured',
        text: timed ? 'measured: times of frames' : 'measured by the program',
      }),
    ),
    element(
      'details',
      {
        open: unfolded,
        ontoggle: (event) => {
          unfolded = event.target.open;
        },
      },
      element('summary', { text: 'Numbers' }),
      table({
        caption: say('{title}: curve', { title: translated(lesson.title) }),
        hideCaption: true,
        columns: [
          { label: pretty(x), numeric: true },
          { label: 'measured', numeric: true },
          { label: 'theory', numeric: true },
        ],
        rows: drawn.map(([at, measured, theory]) => [digits(at), digits(measured, 8), digits(theory, 8)]),
      }),
    ),
  );
}
