/* The curve of a lesson: measured points over the line of theory, and a table of them for screen readers.
 * exports: lessonChart(lesson, result) -> node */

import { digits, element, table } from './ui.js';
import { plot } from './plot.js';

const MARKS = 30; /* more would hide the line */

let unfolded = false; /* a new measurement leaves the table open */

/* A unit in ASCII, as on the command line, in the page's spelling. */
export const pretty = (text) => text.replace(/, deg\b/, ' (°)').replace(/, (px|m|scene units)\b/, ' ($1)');

export function lessonChart(lesson, { points }) {
  const sparse = Math.max(1, Math.ceil(points.length / MARKS));
  const drawn = points.filter((_, i) => i % sparse === 0 || i === points.length - 1);
  const { x, y } = lesson.measure;
  return element(
    'figure',
    { class: 'lesson-chart' },
    plot({
      title: lesson.title,
      width: 560,
      legends: false,
      x: { label: pretty(x) },
      y: { label: pretty(y) },
      series: [
        { name: 'theory', marked: false, points: points.map(([at, , theory]) => ({ x: at, y: theory })) },
        { name: 'measured', joined: false, points: drawn.map(([at, measured]) => ({ x: at, y: measured })) },
      ],
    }),
    element(
      'figcaption',
      { class: 'hint' },
      element('span', { class: 'lesson-key theory', text: 'theory: closed form' }),
      element('span', { class: 'lesson-key measured', text: 'measured: rays traced by the program' }),
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
        caption: `${lesson.title}: curve`,
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
