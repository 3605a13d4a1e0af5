/* A lesson that was chosen: question, prediction, measurement by hand, answer; controls, measured curve next to theory,
 * commands. It shows its rays in the section.
 * exports: createLesson(root, lab, lesson, {back, again}) -> {shown(), end()}
 *   back(), again(): to the gallery, or to the start of the lesson */

import { session } from '../shared/address.js';
import { commandRow } from '../shared/commands.js';
import { say, translated } from '../shared/language.js';
import { theoryChart } from '../shared/theory_chart.js';
import { button, digits, element, notice, number, replace } from '../shared/ui.js';
import { createControl, presentValue } from './lesson_controls.js';
import { createHandStep } from './lesson_hand.js';
import { worksheetButtons } from './worksheet.js';

const REST_MS = 200; /* a measurement starts when the scene has not changed for this time */

const TIMES =
  'Times differ from one measurement to the next, and are longer while other programs run. ' +
  'Each is the median of three frames';
const PLACES = { server: '.', browser: ', measured in this browser.' };

const HOLE = /\{(\w+)\}/g;

const unitOf = (lesson) => (lesson.measure.unit === 'deg' ? '°' : lesson.measure.unit ? ` ${lesson.measure.unit}` : '');

export function createLesson(root, lab, lesson, { back, again }) {
  const result = element('div', { class: 'lesson-result', 'aria-live': 'polite' });
  const verdict = element('div', { 'aria-live': 'polite' });
  const answer = element('div', { class: 'lesson-answer' });
  const commandRows = element('div');
  const commands = element(
    'details',
    { class: 'lesson-commands' },
    element('summary', { text: 'The same numbers on the command line' }),
    commandRows,
  );
  const controls = lesson.controls.map((control) => createControl(lab, control));
  const tries = element(
    'div',
    {},
    controls.map((control) => control.node),
  );
  const lost = element('div', { 'aria-live': 'polite' });
  let measured = null;
  const before = session.get('lesson'); /* of this page before a reload */
  /* open: the measurement is shown, after the prediction or without it */
  let { open, predicted, taken } = before?.name === lesson.name ? before : { open: false, predicted: null };
  const choices = (lesson.prediction.choices || []).map((word) =>
    button(word, () => show(word), { pressed: word === predicted }),
  );
  const reveal = button('Show the measurement', () => show(null), { small: true, kind: 'quiet' });
  const hand = createHandStep(lab, lesson, {
    taken,
    truth: () => measured?.truth,
    take(reading) {
      taken = reading;
      remember();
      draw();
    },
  });
  let timer = 0;
  let asked = 0;

  const heading = element('h3', { class: 'lesson-title', tabindex: '-1', text: lesson.title });
  replace(
    root,
    element(
      'div',
      { class: 'lesson', lang: lesson.language === 'en' ? undefined : lesson.language },
      element('div', { class: 'lesson-top' }, heading, button('All lessons', back, { icon: 'book', small: true })),
      element('p', { class: 'lesson-question', text: lesson.question }),
      element('div', { class: 'lesson-step' }, element('h4', { text: 'Your prediction' }), createPrediction(), verdict),
      hand.node,
      answer,
      lost,
      element('div', { class: 'lesson-step' }, element('h4', { text: 'Try it' }), tries),
      result,
      commands,
      worksheetButtons(lab, lesson),
    ),
  );
  heading.focus();
  const ends = [lab.on('scene', changed), hand.end, () => lab.section?.present(null)];
  lab.section?.present(lesson.show);
  lab.want(
    'lesson',
    lesson.controls.map(({ parameter }) => parameter.split('.')[0]),
  );
  changed();
  return { shown: changed, end: () => ends.forEach((end) => end()) };

  function createPrediction() {
    const { ask } = lesson.prediction;
    const fields = choices.length
      ? element('div', { class: 'lesson-choices', role: 'group', 'aria-label': ask }, choices, reveal)
      : createNumber(ask);
    return element('div', { class: 'lesson-prediction' }, element('p', { text: ask }), fields);
  }

  function createNumber(ask) {
    const field = number({ onchange: null });
    field.input.setAttribute('aria-label', ask);
    const go = () => Number.isFinite(field.value) && show(field.value);
    field.input.addEventListener('keydown', (event) => event.key === 'Enter' && go());
    const compare = button('Compare', go, { kind: 'primary', small: true });
    return element('div', { class: 'buttons' }, field.node, compare, reveal);
  }

  function show(prediction) {
    open = true;
    predicted = prediction ?? predicted;
    remember();
    draw();
  }

  function remember() {
    session.set('lesson', { name: lesson.name, open, predicted, taken });
  }

  function judge() {
    if (predicted === null || !measured || measured.failure) return null;
    const { choices: words, within } = lesson.prediction;
    const good = words ? predicted === measured.right : Math.abs(predicted - measured.measured) <= within;
    if (words) {
      const text = good
        ? say('You predicted: {words}. That is right.', { words: translated(predicted) })
        : say('You predicted: {words}. See what was measured.', { words: translated(predicted) });
      return notice(text, { kind: good ? 'good' : 'info' });
    }
    const by = predicted - measured.measured;
    const about = {
      words: `${digits(predicted)}${unitOf(lesson)}`,
      off: `${digits(Math.abs(by), 3)}${unitOf(lesson)}`,
    };
    const text = good
      ? say('You predicted: {words}. That is right.', about)
      : by < 0
        ? say('You predicted: {words}. That is {off} too small.', about)
        : say('You predicted: {words}. That is {off} too large.', about);
    return notice(text, { kind: good ? 'good' : 'info' });
  }

  /* The text with the values of the present parameters. */
  function filled(text) {
    const { values = {}, theory, measured: reading } = measured || {};
    const known = { theory, measured: reading, ...values };
    return translated(text).replace(HOLE, (whole, key) =>
      key in known ? (Number.isFinite(known[key]) ? digits(known[key]) : '–') : whole,
    );
  }

  function draw() {
    for (const [index, choice] of choices.entries()) {
      const word = lesson.prediction.choices[index];
      choice.setAttribute('aria-pressed', String(word === predicted));
      choice.classList.toggle('right', open && word === measured?.right);
    }
    reveal.hidden = open;
    hand.draw();
    replace(verdict, open ? judge() : null);
    replace(answer, open && measured && !measured.failure ? createAnswer() : null);
    if (!open || !measured) {
      replace(result, null);
      return;
    }
    if (measured.failure) {
      replace(result, notice(measured.failure.message, { kind: 'warning', remedy: measured.failure.remedy }));
      return;
    }
    const { error, points, passes } = measured;
    const allowed = digits(measured.tolerance, 2);
    replace(
      result,
      theoryChart(lesson, measured, { now: presentValue(lab, lesson.measure.x_parameter), predicted }),
      lesson.measure.timed
        ? [
            element('p', { class: 'hint', text: `${translated(TIMES)}${translated(PLACES[lab.engine.kind])}` }),
            button('Measure again', measure, { small: true }),
          ]
        : element('p', {
            class: passes ? 'hint' : 'hint lesson-off',
            text: say('Largest difference of {count} points: {error} (tolerance {allowed}).', {
              count: points.length,
              error: digits(error, 2),
              allowed,
            }),
          }),
    );
  }

  function createAnswer() {
    const { measured: value, theory } = measured;
    return [
      element('h4', { text: 'Measured with traced rays' }),
      element(
        'p',
        { class: 'lesson-reading' },
        element('span', { text: lesson.measure.reading }),
        element('output', { class: 'lesson-value', text: `${digits(value, 6)}${unitOf(lesson)}` }),
        element('span', {
          class: 'hint',
          text:
            theory === null
              ? say('no theory for these values')
              : say('theory: {theory}', { theory: `${digits(theory, 6)}${unitOf(lesson)}` }),
        }),
      ),
      element('h4', { text: 'Answer' }),
      element('p', { class: 'lesson-text', text: filled(lesson.answer) }),
    ];
  }

  /* What is shown after Undo, or when another scene was opened. */
  function whenGone() {
    return [
      notice('The scene of this lesson is not shown any more.', { kind: 'warning' }),
      element('div', { class: 'buttons' }, button('Start this lesson again', again, { kind: 'primary', small: true })),
    ];
  }

  /* Called after a change of the scene: by these controls, undo or another page. */
  function changed() {
    const there = controls.map((control) => control.update());
    const gone = Boolean(lab.scene) && there.includes(false);
    tries.inert = gone;
    replace(lost, gone ? whenGone() : null);
    if (gone) {
      measured = null;
      asked++; /* the running measurement is void */
      draw();
    }
    drawCommands();
    clearTimeout(timer);
    if (!gone) timer = setTimeout(measure, measured ? REST_MS : 0);
  }

  async function measure() {
    if (!root.isConnected || root.closest('[hidden]')) return;
    const mine = ++asked;
    let reply;
    try {
      reply = await lab.get(`/api/lessons/${encodeURIComponent(lesson.name)}/measure`);
    } catch (error) {
      reply = { failure: error };
    }
    if (mine !== asked) return;
    measured = reply;
    draw();
  }

  function drawCommands() {
    const sets = lesson.controls
      .filter(({ parameter }) => !lesson.added.includes(parameter.split('.')[0]))
      .map(({ parameter }) => lab.param(parameter))
      .filter((row) => row && String(row.value) !== String(row.initial))
      .map((row) => ` --set ${row.path}=${row.value}`)
      .join('');
    replace(
      commandRows,
      lesson.commands.map((text) => commandRow(lab, `${text}${sets}`)),
    );
  }
}
