/* A lesson on paper: a worksheet with blanks for the pupil, and a page with the answers for the teacher.
 * exports: worksheetButtons(lab, lesson) -> node */

import { say } from '../shared/language.js';
import { imageOf, printSheets, sheet } from '../shared/print.js';
import { qrCode } from '../shared/qr.js';
import { qrDrawing } from '../shared/qr_drawing.js';
import { pretty } from '../shared/theory_chart.js';
import { button, digits, element } from '../shared/ui.js';

const ROWS = 5;
const LINES = 30; /* more than a page holds */

export const worksheetButtons = (lab, lesson) =>
  element(
    'div',
    { class: 'buttons' },
    button('Worksheet', () => print(lab, lesson, false), {
      small: true,
      title: 'Print a page for the pupil: image, question, a table to fill in, lines for the answer',
    }),
    button("Teacher's page", () => print(lab, lesson, true), {
      small: true,
      title: 'Print the same page with the measured numbers and the answer',
    }),
  );

async function print(lab, lesson, solved) {
  lab.say('Preparing the page …');
  const path = `/api/lessons/${encodeURIComponent(lesson.name)}/measure`;
  const [image, measured] = await Promise.all([imageOf(lab), lab.get(path).catch(() => null)]);
  printSheets([page(lab, lesson, image, measured, solved)]);
  lab.say('The page is ready to print.');
}

/* --- the rows of the table --- */

/* Digits without the zeros at the end: a short number is easy to set. */
const lengthOf = (x) => String(Number(x.toPrecision(6))).replace(/^-?0?\.?0*|\.|0+$/g, '').length;

/* Points over the range of the curve, at short numbers if there are some near. */
function chosenPoints(points) {
  if (points.length <= ROWS) return points;
  const near = Math.max(1, Math.floor(points.length / ROWS / 4));
  return Array.from({ length: ROWS }, (_, i) => {
    const at = Math.round((i * (points.length - 1)) / (ROWS - 1));
    return points
      .slice(Math.max(0, at - near), at + near + 1)
      .reduce((a, b) => (lengthOf(b[0]) < lengthOf(a[0]) ? b : a));
  });
}

/* Without a measurement, the range of the control. */
function pointsOf(lesson, measured) {
  if (measured) return chosenPoints(measured.points);
  const control = lesson.controls.find(({ parameter }) => parameter === lesson.measure.x_parameter);
  const values =
    control?.choices ??
    Array.from({ length: ROWS }, (_, i) => control && control.from + (i / 4) * (control.to - control.from));
  return values.map((x) => [x ?? NaN, NaN, NaN]);
}

const unitOf = ({ measure }) => (measure.unit === 'deg' ? '°' : measure.unit ? ` ${measure.unit}` : '');

const blank = () => element('span', { class: 'sheet-blank' });

/* --- the page --- */

function page(lab, lesson, image, measured, solved) {
  return sheet(
    { class: `sheet worksheet${solved ? ' solved' : ''}`, lang: lesson.language },
    solved ? element('p', { class: 'sheet-head', text: "Teacher's page" }) : nameLine(),
    element('h1', { text: lesson.title }),
    image,
    element('p', { class: 'sheet-question', text: lesson.question }),
    element('h2', { text: 'Your prediction' }),
    prediction(lesson, measured, solved),
    element('h2', { text: 'Measured' }),
    settings(lab, lesson),
    table(lesson, measured, solved),
    reading(lesson, measured, solved),
    element('h2', { text: 'Answer' }),
    solved ? answer(lesson, measured) : lines(),
    foot(lab, lesson),
  );
}

const nameLine = () =>
  element(
    'div',
    { class: 'sheet-head' },
    ['Name', 'Class', 'Date'].map((text) => element('span', { text })),
  );

const lines = () =>
  element(
    'div',
    { class: 'sheet-lines' },
    Array.from({ length: LINES }, () => element('div')),
  );

function prediction(lesson, measured, solved) {
  const { ask, choices, right, within } = lesson.prediction;
  if (choices)
    return [
      element('p', { text: ask }),
      element(
        'ul',
        { class: 'sheet-choices' },
        choices.map((text) => element('li', { class: solved && text === right ? 'right' : null, text })),
      ),
    ];
  const value = solved && measured ? `${digits(measured.measured)} ± ${digits(within)}` : null;
  return element('p', {}, `${ask} `, value ? element('strong', { text: value }) : blank(), unitOf(lesson));
}

/* The controls' values: what the pupil sets, apart from what the table varies. */
function settings(lab, lesson) {
  const shown = lesson.controls
    .filter(({ parameter }) => parameter !== lesson.measure.x_parameter)
    .map(({ parameter, label, choices }) => {
      const [path, part] = parameter.split(/\.([xyzrgb])$/);
      const value = lab.param(path)?.value;
      const one = Array.isArray(value) && part ? value['xyzrgb'.indexOf(part) % 3] : value;
      return `${label}: ${choices || typeof one !== 'number' ? one : digits(one)}`;
    });
  return shown.length ? element('p', { class: 'sheet-settings', text: `${shown.join('; ')}.` }) : null;
}

function table(lesson, measured, solved) {
  const text = (x) => (solved && Number.isFinite(x) ? digits(x) : '');
  const { x, y } = lesson.measure;
  return element(
    'table',
    { class: 'sheet-table' },
    element(
      'tr',
      {},
      element('th', { scope: 'col', text: pretty(x) }),
      element('th', { scope: 'col', text: pretty(y) }),
      element('th', { scope: 'col', text: 'theory' }),
    ),
    pointsOf(lesson, measured).map(([at, value, theory]) =>
      element(
        'tr',
        {},
        element('th', { scope: 'row', text: typeof at === 'number' ? (Number.isFinite(at) ? digits(at) : '') : at }),
        element('td', { text: text(value) }),
        element('td', { text: text(theory) }),
      ),
    ),
  );
}

function reading(lesson, measured, solved) {
  const known = solved && measured;
  return element(
    'p',
    {},
    `${lesson.measure.reading}: `,
    known ? element('strong', { text: digits(measured.measured, 6) }) : blank(),
    unitOf(lesson),
    known && measured.theory !== null
      ? ` (${say('theory: {value}', { value: `${digits(measured.theory, 6)}${unitOf(lesson)}` })})`
      : null,
  );
}

function answer(lesson, measured) {
  return [
    element('p', { text: lesson.answer }),
    measured && !lesson.measure.timed && measured.error !== null
      ? element('p', {
          class: 'sheet-settings',
          text: say('Largest difference of {count} points: {error} (tolerance {allowed}).', {
            count: measured.points.length,
            error: digits(measured.error, 2),
            allowed: digits(measured.tolerance, 2),
          }),
        })
      : null,
    lesson.commands.map((text) => element('pre', { class: 'sheet-command', text })),
    element('div', { class: 'sheet-lines' }),
  ];
}

/* Where the lesson is: a telephone opens it from the code, if it can reach the page. */
function foot(lab, lesson) {
  const address = new URL(`#lesson=${lesson.name}`, new URL(location.pathname, location.href)).href;
  const open = lab.engine.kind === 'browser' && /^https?:$/.test(location.protocol);
  const code = open ? qrCode(address) : null;
  return element(
    'div',
    { class: 'sheet-foot' },
    element('span', { text: open ? address : `Cuvette: ${lesson.name}` }),
    code ? qrDrawing(code) : null,
  );
}
