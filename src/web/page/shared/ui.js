/* Helpers of all modules of the page: elements, controls, dialogs, tables, numbers as text.
 *
 * exports:
 *   element(tag, properties, ...children)      properties: class, text, dataset {}, style {}, on {event: f} or onclick:
 *                                              f, aria-*, and any attribute; false, null and undefined are omitted.
 *                                              children: nodes, strings, lists; null is omitted
 *   svg(tag, attributes, ...children)          the same for SVG elements
 *   replace(node, ...children)                 replaces all children
 *   write(node, {property: value})             assigns the properties that differ
 *   unique(prefix)                             a unique id
 *   gesture(prefix)                            a unique string for one drag
 *   gestures(prefix, pauseMs)                  {at(timeStamp, what, held), end()}: one string for presses of one kind
 *                                              without a pause between them; what: the kind
 *   icon(name)                                 a line icon, of the table in elements.js
 *   button(label, onclick, {icon, kind: 'primary' | 'quiet' | 'danger', title, pressed, small, bare, disabled})
 *                                              bare: the label is for screen readers only
 *   field(label, control, {hint, unit, wide})  a labelled control; it gets an id, and aria-describedby for the hint
 *   number({label, value, min, max, step, unit, onchange(value)})
 *                                              a number field: {node, input, value, set(value)}
 *   text({label, value, placeholder, onchange(value)})           a text field, the same
 *   checkbox(label, checked, onchange(checked))                     a checkbox, the same
 *   slider({label, min, max, step, value, logFrom, unit, oninput(value, gesture), onchange(value, gesture)})
 *                                              a slider with a number field: {node, set(value)}
 *   choice({label, choices, value, radios, onchange(value)})     choices: words or [value, label]; a select or radio
 *                                              buttons: {node, set(value)}
 *   group(title, {open, id, hint}, ...children)    a collapsible section (details); with an id its state is remembered
 *   table({caption, columns, rows, hideCaption, onrow})          columns: names or {label, numeric, key}; cells:
 *                                              string, number, node. The head is sticky
 *   facts(pairs)                               a list of [name, value] as dl
 *   notice(text, {kind: 'info' | 'warning' | 'error' | 'good', remedy})   a box with a message
 *   empty(text)                                a placeholder for missing content
 *   dialog({title, content, actions, wide})    actions: [[label, value, kind]]; {node, close(value), closed: promise of
 *                                              value (null: dismissed)}
 *   ask(title, text, yes, kind)                a question; yes and kind: of its button; promise of true or false
 *   download(blob or address, name)            saves a file by the browser
 *   copy(text)                                 copies to the clipboard; returns a promise
 *   memory.get(key, otherwise), memory.set(key, value)      localStorage, if available
 *   digits(x, n), seconds(s), count(n), vector([..], n)     numbers as text: 4 significant digits unless n is set
 *   timeUnit([s, ..])                          {unit, factor} that suits the largest time
 *   toLinear(byte), toByte(linear)             sRGB 0..255 to and from linear 0..1 */

import { checkbox, choice, number, slider, text } from './controls.js';
import { element, gesture, gestures, icon, memory, replace, svg, unique, write } from './elements.js';
import { count, digits, seconds, timeUnit, toByte, toLinear, vector } from './numbers.js';

export {
  icon,
  table,
  dialog,
  ask,
  slider,
  choice,
  number,
  text,
  checkbox,
  element,
  svg,
  replace,
  write,
  unique,
  gesture,
  gestures,
  memory,
};
export { digits, seconds, timeUnit, count, vector, toLinear, toByte };

export function button(label, onclick, { icon: drawing, kind, title, pressed, small, bare, disabled, ...rest } = {}) {
  const face = drawing ? icon(drawing) : null;
  const node = element(
    'button',
    {
      type: 'button',
      class: ['button', kind, small && 'small', bare && 'bare'].filter(Boolean).join(' '),
      title: title ?? (bare ? label : null),
      disabled,
      'aria-pressed': pressed === undefined ? null : String(pressed),
      onclick,
      ...rest,
    },
    face,
    element('span', { class: bare ? 'visually-hidden' : 'button-label', text: label, translate: rest.translate }),
  );
  return node;
}

export function field(label, control, { hint, unit, wide } = {}) {
  control.id ||= unique('field');
  const about = hint ? element('span', { class: 'hint', id: `${control.id}-hint`, text: hint }) : null;
  if (about) control.setAttribute('aria-describedby', about.id);
  return element(
    'div',
    { class: wide ? 'field wide' : 'field' },
    element('label', { for: control.id, text: label }),
    element('span', { class: 'field-control' }, control, unit ? element('span', { class: 'unit', text: unit }) : null),
    about,
  );
}

export function group(title, { open = true, id, hint } = {}, ...children) {
  const key = id ? `group.${id}` : null;
  const node = element(
    'details',
    { class: 'group', open: key ? memory.get(key, open) : open },
    element(
      'summary',
      {},
      element('h3', { class: 'group-title', text: title }),
      hint ? element('span', { class: 'group-hint', text: hint }) : null,
    ),
    element('div', { class: 'group-body' }, ...children),
  );
  if (key) node.addEventListener('toggle', () => memory.set(key, node.open));
  return node;
}

export function facts(pairs) {
  return element(
    'dl',
    { class: 'facts' },
    pairs.map(([name, value]) => [
      element('dt', { text: name }),
      element('dd', {}, value instanceof Node ? value : String(value ?? '–')),
    ]),
  );
}

export function notice(message, { kind = 'info', remedy } = {}) {
  return element(
    'div',
    { class: `notice ${kind}`, role: kind === 'error' ? 'alert' : null },
    icon(kind === 'good' ? 'check' : kind === 'info' ? 'info' : 'warning'),
    element(
      'div',
      {},
      element('p', { text: message }),
      remedy ? element('p', { class: 'remedy', text: remedy }) : null,
    ),
  );
}

export const empty = (message) => element('p', { class: 'empty', text: message });

export function download(what, name) {
  const address = what instanceof Blob ? URL.createObjectURL(what) : what;
  const link = element('a', { href: address, download: name, hidden: true });
  document.body.append(link);
  link.click();
  link.remove();
  if (what instanceof Blob) setTimeout(() => URL.revokeObjectURL(address), 10000);
}

/* The clipboard API fails when the page has no focus; execCommand still works there. */
export async function copy(words) {
  try {
    await navigator.clipboard.writeText(words);
  } catch {
    const area = element('textarea', { class: 'visually-hidden', readonly: true, 'aria-hidden': 'true' });
    area.value = words;
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    if (!done) throw new Error('the browser denied access to the clipboard');
  }
}

/* --- tables --- */

function cellText(value) {
  if (value === null || value === undefined) return '–';
  return typeof value === 'number' ? digits(value, 6) : String(value);
}

function cell(value, column, first) {
  const numeric = column.numeric ?? typeof value === 'number';
  const content = value instanceof Node ? value : cellText(value);
  return element(first ? 'th' : 'td', { class: numeric ? 'numeric' : null, scope: first ? 'row' : null }, content);
}

function table({ caption, columns, rows, hideCaption = false, onrow }) {
  const heads = columns.map((column) => (typeof column === 'string' ? { label: column } : column));
  const numeric = (column, index) => column.numeric ?? rows.some((row) => typeof row[column.key ?? index] === 'number');
  const head = element(
    'tr',
    {},
    heads.map((column, index) =>
      element('th', {
        scope: 'col',
        class: numeric(column, index) ? 'numeric' : null,
        text: column.label,
        title: column.title,
      }),
    ),
  );
  const body = rows.map((row, line) => {
    const tr = element(
      'tr',
      {},
      heads.map((column, index) => cell(row[column.key ?? index], column, index === 0)),
    );
    if (onrow) onrow(tr, row, line);
    return tr;
  });
  const name = element('caption', { class: hideCaption ? 'visually-hidden' : null, text: caption });
  const inner = element('table', {}, name, element('thead', {}, head), element('tbody', {}, body));
  return element('div', { class: 'table-frame', tabindex: '0', role: 'region', 'aria-label': caption }, inner);
}

/* --- modal dialogs --- */

function dialog({ title, content, actions = [['Close', null]], wide = false }) {
  const id = unique('dialog');
  let answer = null;
  let settle;
  const closed = new Promise((resolve) => {
    settle = resolve;
  });
  const close = (value = null) => {
    answer = value;
    if (node.open) node.close();
  };
  const buttons = actions.map(([label, value, kind]) =>
    element(
      'button',
      {
        type: 'button',
        class: kind ? `button ${kind}` : 'button',
        onclick: () => close(typeof value === 'function' ? value() : value),
      },
      element('span', { class: 'button-label', text: label }),
    ),
  );
  const node = element(
    'dialog',
    { class: wide ? 'dialog wide' : 'dialog', 'aria-labelledby': id },
    element(
      'header',
      { class: 'dialog-head' },
      element('h2', { id, text: title }),
      element(
        'button',
        { type: 'button', class: 'button quiet bare', title: 'Close', onclick: () => close(null) },
        icon('close'),
        element('span', { class: 'visually-hidden', text: 'Close' }),
      ),
    ),
    element('div', { class: 'dialog-body' }, content),
    buttons.length ? element('footer', { class: 'dialog-foot' }, buttons) : null,
  );
  node.addEventListener('close', () => {
    node.remove();
    settle(answer);
  });
  node.addEventListener('click', (event) => {
    if (event.target === node) close(null);
  });
  document.body.append(node);
  node.showModal();
  return { node, close, closed };
}

const ask = (title, words, yes = 'Yes', kind = 'primary') =>
  dialog({
    title,
    content: element('p', { text: words }),
    actions: [
      ['Cancel', false],
      [yes, true, kind],
    ],
  }).closed.then(Boolean);
