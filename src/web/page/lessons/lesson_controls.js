/* The controls of a lesson: a parameter each, with an everyday name.
 * exports:
 *   createControl(lab, {parameter, with, label, from, to, choices}) -> {node, update()}
 *     update: shows the scene's value, and returns false if there is no such parameter
 *   presentValue(lab, path)      the number that the scene has; NaN if a medium replaces it, or for words */

import { whyUnused } from '../edit/param_row.js';
import { say } from '../shared/language.js';
import { checkbox, choice, element, slider } from '../shared/ui.js';

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

export function presentValue(lab, path) {
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
    return name === 'medium' && value === 'ior'
      ? say('index {value}', { value: valueOf(lab, `${object}.ior`) })
      : value;
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
      note.textContent = medium ? say('{medium}; this control replaces it by an index', { medium }) : '';
      made.box.placeholder = medium;
      if (!medium) return;
      made.input.setAttribute('aria-valuetext', medium);
      if (document.activeElement !== made.box) made.box.value = '';
    },
  };
}

export function createControl(lab, about) {
  const { parameter, choices } = about;
  let waiting = 0;
  let settled = 0; /* generation of the last value that this control sent; older scenes do not have the value */
  const set = async (value, gesture) => {
    waiting += 1;
    try {
      const values = { [parameter]: value, ...(about.with ? { [about.with]: value } : {}) };
      settled = Math.max(settled, (await lab.set(values, gesture)).generation || 0);
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
    node: element('div', { class: 'lesson-control', title: parameter }, made.node),
    update() {
      const value = valueOf(lab, parameter);
      if (waiting || lab.scene?.generation < settled) return true;
      if (value !== undefined) made.set(value);
      return value !== undefined;
    },
  };
  return control;
}
