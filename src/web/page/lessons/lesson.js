/* A lesson that was chosen: question, prediction, controls, measured curve next to theory, answer, commands.
 * exports: createLesson(root, lab, lesson, {back, again}) -> {shown(), end()}
 *   back(), again(): to the gallery, or to the start of the lesson */

import { session } from '../shared/address.js';
import { whyUnused } from '../edit/param_row.js';
import { commandRow } from '../shared/commands.js';
import { theoryChart } from '../shared/theory_chart.js';
import { worksheetButtons } from './worksheet.js';
import { button, checkbox, choice, digits, element, notice, number, replace, slider } from '../shared/ui.js';

const REST_MS = 200; /* a measurement starts when the scene has not changed for this time */

const TIMES =
  'Times differ from one measurement to the next, and are longer while other programs run. ' +
  'Each is the median of three frames';
const PLACES = { server: '.', browser: ', measured in this browser.' };

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
  let { open, predicted } = before?.name === lesson.name ? before : { open: false, predicted: null };
  let timer = 0;
  let asked = 0;

  const heading = element('h3', { class: 'lesson-title', tabindex: '-1', text: lesson.title });
  replace(
    root,
    element(
      'div',
      { class: 'lesson', lang: lesson.language },
      element('div', { class: 'buttons' }, button('All lessons', back, { icon: 'book', small: true })),
      heading,
      element('p', { class: 'lesson-question', text: lesson.question }),
      element('h4', { text: 'Your prediction' }),
      createPrediction(),
      verdict,
      element('h4', { text: 'Try it' }),
      lost,
      tries,
      result,
      answer,
      commands,
      worksheetButtons(lab, lesson),
    ),
  );
  heading.focus();
  const ends = [lab.on('scene', changed)];
  changed();
  return { shown: changed, end: () => ends.forEach((end) => end()) };

  function createPrediction() {
    const { ask, choices } = lesson.prediction;
    const reveal = button('Show the measurement', () => show(null), { small: true });
    const answer = choices
      ? [
          element(
            'div',
            { class: 'lesson-choices', role: 'group', 'aria-label': ask },
            choices.map((word) => button(word, () => show(word))),
          ),
          element('div', { class: 'buttons' }, reveal),
        ]
      : [createNumber(ask, reveal)];
    return element('div', { class: 'lesson-prediction' }, element('p', { text: ask }), ...answer);
  }

  function createNumber(ask, reveal) {
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
    session.set('lesson', { name: lesson.name, open, predicted });
    draw();
  }

  function judge() {
    if (predicted === null || !measured) return null;
    const { choices, right, within } = lesson.prediction;
    const good = choices ? predicted === right : Math.abs(predicted - measured.measured) <= within;
    const words = choices ? predicted : `${digits(predicted)}${unitOf(lesson)}`;
    const by = choices ? 0 : predicted - measured.measured;
    const off = choices
      ? 'See what was measured.'
      : `That is ${digits(Math.abs(by), 3)}${unitOf(lesson)} too ${by < 0 ? 'small' : 'large'}.`;
    return notice(`You predicted: ${words}. ${good ? 'That is right.' : off}`, { kind: good ? 'good' : 'info' });
  }

  function draw() {
    replace(verdict, open ? judge() : null);
    replace(answer, open ? [element('h4', { text: 'Answer' }), element('p', { text: lesson.answer })] : null);
    if (!open || !measured) {
      replace(result, null);
      return;
    }
    if (measured.failure) {
      replace(result, notice(measured.failure.message, { kind: 'warning', remedy: measured.failure.remedy }));
      return;
    }
    const { measured: value, theory, error, points, passes } = measured;
    const allowed = digits(measured.tolerance, 2);
    replace(
      result,
      element('h4', { text: 'Measured' }),
      element(
        'p',
        { class: 'lesson-reading' },
        element('span', { text: lesson.measure.reading }),
        element('output', { class: 'lesson-value', text: `${digits(value, 6)}${unitOf(lesson)}` }),
        element('span', {
          class: 'hint',
          text: theory === null ? 'no theory for these values' : `theory: ${digits(theory, 6)}${unitOf(lesson)}`,
        }),
      ),
      theoryChart(lesson, measured, { now: presentValue(lab, lesson.measure.x_parameter), predicted }),
      lesson.measure.timed
        ? [
            element('p', { class: 'hint', text: `${TIMES}${PLACES[lab.engine.kind]}` }),
            button('Measure again', measure, { small: true }),
          ]
        : element('p', {
            class: passes ? 'hint' : 'hint lesson-off',
            text: `Largest difference of ${points.length} points: ${digits(error, 2)} (tolerance ${allowed}).`,
          }),
    );
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

/* --- controls: one parameter each, with an everyday name ---
 * A control is {node, update()}; update shows the scene's value, and returns false if there is no such parameter. */

const PART = /\.([xyzrgb])$/;
const splitPath = (path) => path.replace(PART, '').split('.');

function valueOf(lab, path) {
  const value = lab.param(path.replace(PART, ''))?.value;
  const part = path.match(PART);
  return Array.isArray(value) && part ? value['xyzrgb'.indexOf(part[1]) % 3] : value;
}

/* The medium that an index comes from, if not from the parameter itself; '' for other parameters. */
function mediumOf(lab, path) {
  const [object, name] = splitPath(path);
  return name === 'ior' && whyUnused(lab, object, name) ? lab.param(`${object}.medium`).value : '';
}

function presentValue(lab, path) {
  if (!path || mediumOf(lab, path)) return NaN;
  const value = valueOf(lab, path);
  return value === null || value === undefined || value === '' ? NaN : Number(value);
}

/* A word that is not among the choices, such as a medium that was set in another panel, is added. */
function createChoice(lab, { parameter, label, choices }, set) {
  const known = choices.map(String);
  const made = choice({ label, choices: known, value: '', onchange: set });
  const other = element('option', {});
  const words = (value) => {
    const [object, name] = splitPath(parameter);
    return name === 'medium' && value === 'ior' ? `index ${valueOf(lab, `${object}.ior`)}` : value;
  };
  return {
    node: made.node,
    set(value) {
      const word = String(value);
      if (known.includes(word)) other.remove();
      else {
        Object.assign(other, { value: word, textContent: words(word) });
        made.input.append(other);
      }
      made.set(word);
    },
  };
}

function createSwitch({ label }, set) {
  const made = checkbox(label, false, (on) => set(on ? 'on' : 'off'));
  return { node: made.node, set: (value) => made.set(String(value) === 'on' || value === true) };
}

/* While a medium has precedence, its name is shown instead of the index. */
function createRange(lab, { parameter, label, from, to }, set) {
  const made = slider({ label, min: from, max: to, value: from, oninput: set });
  const note = element('p', { class: 'lesson-medium', hidden: true });
  return {
    node: element('div', {}, made.node, note),
    set(value) {
      const medium = mediumOf(lab, parameter);
      made.set(value);
      made.node.classList.toggle('lesson-unused', Boolean(medium));
      note.hidden = !medium;
      note.textContent = medium ? `${medium}; this control replaces it by an index` : '';
      made.box.placeholder = medium;
      if (!medium) return;
      made.input.setAttribute('aria-valuetext', medium);
      if (document.activeElement !== made.box) made.box.value = '';
    },
  };
}

function createControl(lab, about) {
  const { parameter, choices } = about;
  let waiting = 0;
  let settled = 0; /* generation of the last value that this control sent; older scenes do not have the value */
  const set = async (value, gesture) => {
    waiting += 1;
    try {
      settled = Math.max(settled, (await lab.set({ [parameter]: value }, gesture)).generation || 0);
    } catch (error) {
      lab.fail(error);
      settled = 0;
    }
    waiting -= 1;
    control.update();
  };
  const isSwitch = choices?.length === 2 && choices.includes('on') && choices.includes('off');
  const made = isSwitch
    ? createSwitch(about, set)
    : choices
      ? createChoice(lab, about, (value) => set(value))
      : createRange(lab, about, set);
  const control = {
    node: element(
      'div',
      { class: 'lesson-control' },
      made.node,
      element('code', { class: 'lesson-path', text: parameter }),
    ),
    update() {
      const value = valueOf(lab, parameter);
      if (waiting || lab.scene?.generation < settled) return true;
      if (value !== undefined) made.set(value);
      return value !== undefined;
    },
  };
  return control;
}
