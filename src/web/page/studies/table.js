/* The tables of a study.
 * exports:
 *   createSortTable({caption}) -> {node, show(columns, rows)}     a text table with sortable columns; columns: names;
 *     rows: lists of texts. Columns of times are shown in s, ms or µs. The first click on a head sorts by that column,
 *     the second reverses the order, the third restores the original order
 *   createRows(lab) -> {node, show(study, count)}                 the raw rows, newest first */

import { say } from '../shared/language.js';
import { saveReply } from '../shared/save_file.js';
import { button, count as inWords, digits, element, empty, group, icon, replace, timeUnit } from '../shared/ui.js';
import { isNumeric, numberOf, unitOf } from './data.js';

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
  let units = []; /* of the columns of times; undefined for others */
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

/* --- raw rows --- */

const PAGE = 50;
const MOST = 1000;
const addressOf = (study) => `/api/studies/${encodeURIComponent(study.name)}/rows`;

export function createRows(lab) {
  const sorted = createSortTable({ caption: 'Raw rows, newest first' });
  const about = element('p', { class: 'hint' });
  const more = button(
    'Show 50 more',
    () => {
      limit += PAGE;
      fetchRows();
    },
    { small: true },
  );
  const save = button('Save rows as CSV', () => saveReply(lab, `${addressOf(study)}.csv`, `${study.name}-rows.csv`), {
    icon: 'download',
    small: true,
  });
  const place = element('div', { class: 'study-part' });
  const node = group('Raw rows', { open: false, id: 'study-rows', hint: 'as measured' }, place);
  node.addEventListener('toggle', () => fetchRows());
  let study = null;
  let count = 0;
  let limit = PAGE;
  let shown = '';
  return {
    node,
    show(next, rows) {
      if (next.name !== study?.name) limit = PAGE;
      study = next;
      count = rows;
      fetchRows();
    },
  };

  async function fetchRows() {
    if (!node.open || !study) return;
    const key = `${study.name} ${count} ${limit}`;
    if (key === shown) return;
    shown = key;
    if (!count) {
      replace(place, empty('No rows yet.'));
      return;
    }
    try {
      const reply = await lab.get(`${addressOf(study)}?from=${Math.max(0, count - limit)}`);
      if (key === shown) draw(reply);
    } catch (error) {
      lab.fail(error);
    }
  }

  function draw(reply) {
    const rows = reply.rows.slice(-limit).reverse();
    about.textContent = say('{shown} of {n} rows', { shown: inWords(rows.length), n: inWords(reply.count) });
    more.disabled = rows.length >= reply.count || limit >= MOST;
    if (!place.contains(sorted.node))
      replace(place, sorted.node, element('div', { class: 'buttons' }, save, more, about));
    sorted.show(reply.columns, rows);
  }
}
