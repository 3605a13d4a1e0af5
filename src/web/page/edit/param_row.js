/* One parameter: its name, control, unit, reset button, description, and the reason for a rejected value.
 * exports:
 *   createRow(row, lab, {onabout(row), long}) -> {node, path, update(row, generation), busy()}
 *     long: the label includes the object's name; busy(): whether the control is being dragged; node is .param with
 *     data-path; its slider is an input of type range, its number field an input of type text (numberInput)
 *   shortUnit(unit) -> the text after a field
 *   valueText(value) -> the value as text; 'none' for an empty one
 *   hasLaw(lab, object)               whether the object's medium has coefficients
 *   whyUnused(lab, object, name)      why that parameter has no effect now; '' if it has an effect */

import { say, translated } from '../shared/language.js';
import { button, element, unique } from '../shared/ui.js';
import { controlOf, written } from './param_controls.js';

/* --- which rows of a medium are in use ---
 * A medium has its refractive index from `ior`, from a dispersion law with coefficients, or from the catalogue. */

const value = (lab, object, name) => lab.param(`${object}.${name}`)?.value;

const lawsOf = (lab, object) => lab.param(`${object}.ior`)?.first_coefficients ?? {};

export const hasLaw = (lab, object) => value(lab, object, 'medium') in lawsOf(lab, object);

export function whyUnused(lab, object, name) {
  const medium = value(lab, object, 'medium');
  if (!medium) return '';
  if (name === 'ior' && medium !== 'ior')
    return say('the index comes from the medium {medium}; a value set here replaces it', { medium });
  if (name === 'coefficients' && value(lab, object, name).length && !hasLaw(lab, object))
    return say('the medium {medium} uses no coefficients', { medium });
  return '';
}

/* The values that set a medium. For a dispersion law also its coefficients: those of the opened scene if that had this
 * law, otherwise coefficients close to the current index. */
function withMedium(lab, object, medium) {
  const set = { [`${object}.medium`]: medium };
  const first = lawsOf(lab, object)[medium];
  if (!first) return set;
  const was = lab.param(`${object}.coefficients`)?.initial;
  const kept = lab.param(`${object}.medium`)?.initial === medium && was?.length;
  return { ...set, [`${object}.coefficients`]: kept ? was : first };
}

let media = null; /* the promise of GET /api/media, once it is needed */

async function layersOf(lab, design) {
  media ??= lab.get('/api/media');
  return (await media).coatings.find(({ name }) => name === design)?.layers ?? design;
}

/* The names of the objects of a kind, unless there are too many to choose from. */
function suggested(lab, kind) {
  const names = kind ? lab.scene.objects.filter((each) => each.kind === kind).map((each) => each.name) : [];
  return names.length <= NAMES_MAX ? names : [];
}

const NAMES_MAX = 200;
const FORGET_MS = 8000;

const labelOf = (name) => translated(name.replaceAll('_', ' '));
const equal = (a, b) => JSON.stringify(a) === JSON.stringify(b);

/* 'u' for scene units; exponents as superscripts. */
export const shortUnit = (unit) =>
  unit === 'deg'
    ? '°'
    : unit
        .replace(/scene units?/g, 'u')
        .replace('^2', '²')
        .replace('^3', '³');

export function valueText(value) {
  if (Array.isArray(value)) return value.length ? value.map(valueText).join(', ') : 'none';
  if (typeof value === 'number') return written(value);
  return value === '' || value === null ? 'none' : String(value);
}

export function createRow(first, lab, { onabout, long } = {}) {
  const { path } = first;
  const object = path.slice(0, path.length - first.name.length - 1);
  const about = {
    meaning: translated(first.meaning),
    range: translated(first.range),
    value: valueText(first.default),
    needs: first.needs,
  };
  const meaning = element('span', {
    class: 'param-meaning',
    id: unique('meaning'),
    text: first.needs
      ? say('{meaning}. {range}; default {value}; needs {needs}', about)
      : say('{meaning}. {range}; default {value}', about),
  });
  const problem = element('p', { class: 'param-problem', role: 'alert', hidden: true });
  const unused = element('span', { class: 'param-unused', text: 'unused', hidden: true });
  const title = () =>
    [
      long ? element('span', { class: 'param-object', translate: 'no', text: object }) : null,
      labelOf(first.name),
      unused,
    ].filter(Boolean);
  const label = element('label', { class: 'param-label', title: path }, title());
  const reset = button(say('Reset {name}', { name: path }), undo, {
    icon: 'reset',
    bare: true,
    small: true,
    kind: 'quiet',
  });
  let known = first;
  let waiting = 0;
  let settled = 0;
  let forget = 0;

  const control = controlOf(first, {
    name: `${object} ${labelOf(first.name)}`,
    describedby: meaning.id,
    send,
    slider: () => known.slider,
    layers: (design) => layersOf(lab, design),
    names: suggested(lab, first.names),
  });
  label.id = unique('label');
  if (control.single) label.htmlFor = control.single.id;
  const node = element(
    'div',
    {
      class: 'param',
      role: control.single ? null : 'group',
      'aria-label': control.single ? null : `${object} ${labelOf(first.name)}`,
      dataset: { path },
    },
    control.single ? label : element('span', { class: 'param-label', title: path }, title()),
    element(
      'div',
      { class: 'param-control' },
      control.node,
      element('span', { class: 'unit', text: shortUnit(first.unit), title: first.unit || null }),
    ),
    reset,
    meaning,
    problem,
  );
  node.addEventListener('pointerenter', () => onabout?.(known));
  node.addEventListener('focusin', () => onabout?.(known));
  node.addEventListener('focusout', () => {
    clearTimeout(forget);
    forget = setTimeout(() => {
      if (!node.contains(document.activeElement)) refuse(null);
    }, FORGET_MS);
  });
  showReset();
  showUse();
  return { node, path, update, busy: () => control.busy() };

  function showReset() {
    const away = known.initial !== undefined && known.initial !== null && !equal(known.value, known.initial);
    reset.classList.toggle('unseen', !away);
    reset.disabled = !away;
    reset.title = away ? say('Reset to {value}', { value: valueText(known.initial) }) : '';
    node.classList.toggle('changed', away);
  }

  function showUse() {
    const why = whyUnused(lab, object, first.name);
    unused.hidden = !why;
    unused.title = why;
  }

  function refuse(error) {
    problem.hidden = !error;
    problem.textContent = error ? [error.message, error.remedy].filter(Boolean).join(' – ') : '';
    for (const input of control.inputs) {
      if (error) input.setAttribute('aria-invalid', 'true');
      else input.removeAttribute('aria-invalid');
    }
  }

  async function send(value, gesture) {
    waiting += 1;
    let error = null;
    try {
      const reply = await lab.set(
        first.name === 'medium' ? withMedium(lab, object, value) : { [path]: value },
        gesture,
      );
      settled = Math.max(settled, reply.generation || 0);
      known = { ...known, value };
    } catch (caught) {
      error = caught;
    }
    waiting -= 1;
    if (waiting) return;
    if (error && error.status !== 0 && error.status !== 401) refuse(error);
    else refuse(null);
    if (error) {
      known = lab.param(path) || known;
      force(known.value);
    }
    showReset();
  }

  /* Also updates the field that has the focus. */
  function force(value) {
    const focused = document.activeElement;
    if (control.inputs.includes(focused)) focused.blur();
    control.set(value, true);
    if (control.inputs.includes(focused)) focused.focus({ preventScroll: true });
  }

  function undo() {
    refuse(null);
    lab.change('/api/reset', { paths: [path] }).catch(refuse);
    (control.single || control.inputs[0]).focus();
  }

  /* Ignores a scene that is older than the last value sent by this row. */
  function update(row, generation) {
    showUse();
    if (waiting || control.busy() || generation < settled) return;
    const changed = !equal(row.value, known.value);
    known = row;
    control.set(row.value);
    if (changed) refuse(null);
    showReset();
  }
}
