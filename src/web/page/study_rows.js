/* The raw rows of a study, the newest first. exports: createRows(lab) -> {node, show(study, count), forget()} */

import { button, count as inWords, element, empty, group, replace } from './ui.js';
import { createSortTable } from './study_table.js';

const PAGE = 50;
const MOST = 1000;

export function createRows(lab) {
  const sorted = createSortTable({ caption: 'Raw rows, the newest first' });
  const about = element('p', { class: 'hint' });
  const more = button(
    'Show 50 more',
    () => {
      wanted += PAGE;
      fetchRows();
    },
    { small: true },
  );
  const place = element('div', { class: 'study-part' });
  const node = group('Raw rows', { open: false, id: 'study-rows', hint: 'as they were measured' }, place);
  node.addEventListener('toggle', () => fetchRows());
  let study = null;
  let count = 0;
  let wanted = PAGE;
  let shown = '';
  return {
    node,
    show(next, rows) {
      if (next.name !== study?.name) wanted = PAGE;
      study = next;
      count = rows;
      fetchRows();
    },
  };

  async function fetchRows() {
    if (!node.open || !study) return;
    const key = `${study.name} ${count} ${wanted}`;
    if (key === shown) return;
    shown = key;
    if (!count) {
      replace(place, empty('There are no rows yet.'));
      return;
    }
    try {
      const told = await lab.get(
        `/api/studies/${encodeURIComponent(study.name)}/rows?from=${Math.max(0, count - wanted)}`,
      );
      if (key === shown) draw(told);
    } catch (error) {
      lab.fail(error);
    }
  }

  function draw(told) {
    const rows = told.rows.slice(-wanted).reverse();
    about.textContent = `${inWords(rows.length)} of ${inWords(told.count)} rows`;
    more.disabled = rows.length >= told.count || wanted >= MOST;
    if (!place.contains(sorted.node)) replace(place, sorted.node, element('div', { class: 'buttons' }, more, about));
    sorted.show(told.columns, rows);
  }
}
