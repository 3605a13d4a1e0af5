/* The dialog New study: a study of the current scene from axes, repetitions and warm-ups, estimated before it is saved.
 * exports: createStudyForm(lab, {files(), onsaved(file, start)}) -> {open()}
 *   files: the study files that exist. Closing the dialog keeps what was entered. */

import { say } from '../shared/language.js';
import { numberInput, numberOf } from '../shared/controls.js';
import { button, checkbox, count, dialog, element, facts, field, notice, replace, seconds } from '../shared/ui.js';
import { createAxis } from './axis.js';

const AXES_MAX = 16;
const SHOWN_MAX = 400; /* characters of an axis in an error */

const named = (text) => (/\.study$/.test(text.trim()) ? text.trim() : `${text.trim()}.study`);

/* A file name after the scene's: glass/rod.yaml makes rod-study.study. */
function suggestion(lab) {
  const scene = (lab.state?.file || 'scene')
    .split('/')
    .at(-1)
    .replace(/\.[^.]*$/, '');
  return `${scene}-study.study`;
}

const time = ({ least_s: least, most_s: most }) =>
  least === most
    ? say('about {time}', { time: seconds(most) })
    : say('{least} to {most}', { least: seconds(least), most: seconds(most) });

function estimated({ cells, rows, notes, text, said, ...times }) {
  return [
    facts([
      ['Cells', count(cells)],
      ['Rows', count(rows)],
      ['Time', time(times)],
    ]),
    notes.map(({ text: words, remedy }) => notice(words, { kind: 'warning', remedy })),
    element(
      'details',
      { class: 'study-text' },
      element('summary', { text: 'The study file, and how the time is estimated' }),
      element('pre', { tabindex: '0', text: said }),
      element('pre', { tabindex: '0', text }),
    ),
  ];
}

/* A field with a place for the error that names it. */
function located(label, input, options) {
  const problem = element('p', { class: 'form-problem', role: 'alert', hidden: true });
  const node = element('div', { class: 'form-part' }, field(label, input, options), problem);
  return {
    node,
    input,
    problem(words) {
      problem.hidden = !words;
      problem.textContent = words || '';
      if (words) input.setAttribute('aria-invalid', 'true');
      else input.removeAttribute('aria-invalid');
    },
  };
}

function createFields(lab) {
  const text = element('input', {
    type: 'text',
    class: 'input',
    value: suggestion(lab),
    autocomplete: 'off',
    spellcheck: 'false',
  });
  return {
    file: located('File', text),
    repetitions: located('Repetitions', numberInput({ min: 1, step: 1, value: '6' }), {
      hint: 'measured frames of each cell; from 6 on, medians have a 95% interval',
    }),
    warmups: located('Warm-ups', numberInput({ min: 0, step: 1, value: '1' }), {
      hint: 'frames of each cell before its first measured one',
    }),
  };
}

/* The form itself; done(file, start) after it was saved. */
function createForm(lab, files, done) {
  const fields = createFields(lab);
  const scene = element('p', { class: 'hint' });
  const axes = element('div', { class: 'study-axes-form' });
  const more = button('Add an axis', () => addAxis().focus(), { icon: 'plus', small: true });
  const over = checkbox('Replace the existing file', false, () => fields.file.problem(null));
  const result = element('div', { class: 'study-estimate', 'aria-live': 'polite' });
  const buttons = [
    button('Estimate', () => act(estimate), { icon: 'estimate' }),
    button('Save', () => act(save(false)), { icon: 'save' }),
    button('Save and start', () => act(save(true)), { icon: 'play', kind: 'primary' }),
  ];
  const node = element(
    'div',
    { class: 'study-form' },
    scene,
    fields.file.node,
    over.node,
    axes,
    more,
    fields.repetitions.node,
    fields.warmups.node,
    result,
    element('div', { class: 'buttons study-form-foot' }, buttons),
  );
  const list = [];
  over.node.hidden = true;
  for (const each of Object.values(fields)) each.input.addEventListener('input', changed);
  fields.file.input.addEventListener('input', () => {
    over.node.hidden = true;
    over.set(false);
  });
  addAxis();
  return {
    node,
    first: () => list[0].focus(),
    shown() {
      const { file, saved } = lab.state || {};
      scene.textContent = file
        ? saved
          ? say('A study of {file}.', { file })
          : say('A study of {file}, with its unsaved changes in all cells.', { file })
        : say('The scene has no file yet: save it first.');
    },
  };

  function addAxis() {
    const axis = createAxis(lab, { onchange: changed, onremove: removeAxis });
    list.push(axis);
    axes.append(axis.node);
    number();
    return axis;
  }

  function removeAxis(axis) {
    list.splice(list.indexOf(axis), 1);
    axis.node.remove();
    number();
    changed();
    list.at(-1).focus();
  }

  function number() {
    list.forEach((axis, i) => {
      axis.name(i + 1);
      axis.removable(list.length > 1);
    });
    more.hidden = list.length >= AXES_MAX;
  }

  /* Removes the estimate, which was for the form before the change, and the error of the changed field. */
  function changed(event) {
    replace(result);
    for (const each of Object.values(fields)) if (event?.target === each.input) each.problem(null);
  }

  function body() {
    const texts = list.map((axis) => axis.text());
    const wrong = ['repetitions', 'warmups'].find((key) => {
      const { input } = fields[key];
      input.dispatchEvent(new Event('change'));
      fields[key].problem(input.validationMessage || (Number.isFinite(numberOf(input)) ? null : 'Enter a number.'));
      return !input.checkValidity() || !Number.isFinite(numberOf(input));
    });
    fields.file.input.value = named(fields.file.input.value);
    if (wrong || texts.includes(null)) return null;
    return {
      file: fields.file.input.value,
      axes: texts,
      repetitions: numberOf(fields.repetitions.input),
      warmups: numberOf(fields.warmups.input),
    };
  }

  async function act(work) {
    for (const each of list) each.problem(null);
    fields.file.problem(null);
    replace(result);
    for (const each of buttons) each.disabled = true;
    node.setAttribute('aria-busy', 'true');
    const form = body();
    try {
      if (form) await work(form);
    } catch (error) {
      refuse(error, form);
    }
    node.removeAttribute('aria-busy');
    for (const each of buttons) each.disabled = false;
    node.querySelector('[aria-invalid]')?.focus();
  }

  /* Shows the error next to the field that it names, or below the form. */
  function refuse(error, form) {
    const words = [error.message, error.remedy].filter(Boolean).join('; ');
    const axis = list[form.axes.findIndex((text) => error.file === `--axis ${text.slice(0, SHOWN_MAX)}`)];
    const place = axis || fields[error.file];
    replace(result);
    if (error.file === 'file' && error.status === 409) over.node.hidden = !files().includes(form.file);
    if (place) place.problem(words);
    else replace(result, notice(error.message, { kind: 'error', remedy: error.remedy }));
  }

  async function estimate(form) {
    replace(result, element('p', { class: 'hint', text: 'Rendering trial frames …' }));
    replace(result, estimated(await lab.post('/api/studies', form)));
    result.scrollIntoView({ block: 'nearest' });
  }

  function save(start) {
    return async (form) => {
      const { file } = await lab.post('/api/studies', { ...form, save: true, replace: over.value });
      done(file, start);
    };
  }
}

export function createStudyForm(lab, { files, onsaved }) {
  let form = null;
  let shown = null;
  return { open };

  function open() {
    form ??= createForm(lab, files, (file, start) => {
      form = null;
      shown.close();
      onsaved(file, start);
    });
    shown = dialog({ title: 'New study', content: form.node, actions: [], wide: true });
    form.shown();
    form.first();
  }
}
