/* The raw rows of a study, newest first. exports: createRows(lab) -> {node, show(study, count), forget()} */

import { button, count as inWords, element, empty, group, replace } from './ui.js';
import { saveReply } from './save_file.js';
import { createSortTable } from './study_table.js';

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
    icon: 'save',
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
    about.textContent = `${inWords(rows.length)} of ${inWords(reply.count)} rows`;
    more.disabled = rows.length >= reply.count || limit >= MOST;
    if (!place.contains(sorted.node))
      replace(place, sorted.node, element('div', { class: 'buttons' }, save, more, about));
    sorted.show(reply.columns, rows);
  }
}
