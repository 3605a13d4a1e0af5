/* A table with a caption and a head. exports: table (see ui.js) */

import { element } from './ui_base.js';
import { digits } from './ui_numbers.js';

function cellText(value) {
  if (value === null || value === undefined) return '–';
  return typeof value === 'number' ? digits(value, 6) : String(value);
}

function cell(value, column, first) {
  const numeric = column.numeric ?? typeof value === 'number';
  const content = value instanceof Node ? value : cellText(value);
  return element(first ? 'th' : 'td', { class: numeric ? 'numeric' : null, scope: first ? 'row' : null }, content);
}

export function table({ caption, columns, rows, hideCaption = false, onrow }) {
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
