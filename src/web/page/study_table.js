/* A text table with sortable columns; columns of times are shown in s, ms or µs.
 * exports: createSortTable({caption, mono}) -> {node, show(columns, rows)}
 * columns: names; rows: lists of texts. The first click on a head sorts by that column, the second reverses the
 * order, the third restores the original order. */

import { digits, element, icon, replace, timeUnit } from './ui.js';
import { isNumeric, numberOf, unitOf } from './study_data.js';

const ORDERS = ['none', 'ascending', 'descending'];

export function createSortTable({ caption }) {
  const head = element('tr');
  const body = element('tbody');
  const frame = element(
    'div',
    { class: 'table-frame study-table', tabindex: '0', role: 'region', 'aria-label': caption },
    element(
      'table',
      {},
      element('caption', { class: 'visually-hidden', text: caption }),
      element('thead', {}, head),
      body,
    ),
  );
  let columns = [];
  let rows = [];
  let units = []; /* of columns of times */
  let by = null;
  let order = 'none';
  return { node: frame, show };

  function show(nextColumns, nextRows) {
    const before = columns.join() + units.join();
    columns = nextColumns;
    rows = nextRows;
    units = columns.map((_, index) => timesIn(index)?.unit);
    if (columns.join() + units.join() !== before) drawHead();
    drawBody();
  }

  function sortBy(column) {
    order = by === column ? ORDERS[(ORDERS.indexOf(order) + 1) % ORDERS.length] : 'ascending';
    by = column;
    drawHead();
    drawBody();
    head.querySelectorAll('button')[columns.indexOf(column)].focus();
  }

  /* The unit of a column of times; null for others. */
  function timesIn(index) {
    const values = rows.map((row) => numberOf(row[index]));
    return unitOf(columns[index]) === 's' && isNumeric(columns[index], rows, index) ? timeUnit(values) : null;
  }

  function drawHead() {
    replace(
      head,
      columns.map((column, index) => {
        const sorted = column === by ? order : 'none';
        return element(
          'th',
          { scope: 'col', class: isNumeric(column, rows, index) ? 'numeric' : null, 'aria-sort': sorted },
          element(
            'button',
            { type: 'button', class: 'study-sort', onclick: () => sortBy(column) },
            column,
            units[index] && units[index] !== 's' ? ` / ${units[index]}` : null,
            sorted === 'none' ? null : icon(sorted === 'ascending' ? 'up' : 'down'),
          ),
        );
      }),
    );
  }

  function inOrder(numeric) {
    const index = columns.indexOf(by);
    if (index < 0 || order === 'none') return rows;
    const sign = order === 'ascending' ? 1 : -1;
    const last = (value) => (Number.isNaN(value) ? 1 : 0);
    return [...rows].sort((a, b) => {
      if (!numeric[index]) return sign * String(a[index]).localeCompare(String(b[index]), 'en', { numeric: true });
      const [x, y] = [numberOf(a[index]), numberOf(b[index])];
      return last(x) - last(y) || sign * (x - y);
    });
  }

  function drawBody() {
    const numeric = columns.map((column, index) => isNumeric(column, rows, index));
    const factors = columns.map((_, index) => timesIn(index)?.factor ?? 1);
    replace(
      body,
      inOrder(numeric).map((row) =>
        element(
          'tr',
          {},
          row.map((value, index) =>
            element(index === 0 ? 'th' : 'td', {
              class: numeric[index] ? 'numeric' : null,
              scope: index === 0 ? 'row' : null,
              title: numeric[index] && value.length > 7 ? value : null,
              text: value === 'NA' ? '–' : numeric[index] ? digits(factors[index] * numberOf(value), 5) : value,
            }),
          ),
        ),
      ),
    );
  }
}
