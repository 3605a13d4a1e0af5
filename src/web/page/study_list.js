/* The list of studies: one button per study, with its progress. exports: createStudyList({onchoose}) -> {node,
 * show(studies, chosen, running)} */

import { element, icon, replace, unique } from './ui.js';

const shareOf = ({ frames_done: done, frames_all: all, share }) => (all ? (done + (share || 0)) / all : 0);

function state(study, running) {
  if (running) return `running, ${Math.floor(100 * shareOf(running))} %`;
  if (study.error) return 'cannot be read';
  if (study.cells_done >= study.cells) return 'complete';
  return study.rows ? `${study.cells_done} of ${study.cells} cells` : `${study.cells} cells`;
}

function entry(study, chosen, running, onchoose) {
  const now = running?.name === study.name && !study.error ? running : null;
  const value = now ? shareOf(now) : study.cells ? study.cells_done / study.cells : 0;
  return element(
    'li',
    {},
    element(
      'button',
      {
        type: 'button',
        class: 'study-entry',
        'aria-current': study.file === chosen ? 'true' : null,
        dataset: { file: study.file },
        onclick: () => onchoose(study),
      },
      element(
        'span',
        { class: 'study-entry-name' },
        now ? icon('play') : study.error ? icon('warning') : study.cells_done >= study.cells ? icon('check') : null,
        study.name,
      ),
      element('span', { class: study.error ? 'study-entry-state bad' : 'study-entry-state', text: state(study, now) }),
      element('span', { class: 'study-entry-title', text: study.error ? study.error.error : study.title }),
      study.error ? null : element('progress', { max: 1, value: String(value), 'aria-label': `${study.name}, done` }),
    ),
  );
}

export function createStudyList({ onchoose }) {
  const id = unique('search');
  const search = element('input', {
    type: 'search',
    class: 'input',
    id,
    placeholder: 'Search studies',
    autocomplete: 'off',
  });
  const list = element('ul', { class: 'study-list' });
  const none = element('p', { class: 'hint', text: 'No study matches in name, title or file.', hidden: true });
  const node = element(
    'nav',
    { class: 'study-nav', 'aria-label': 'Studies' },
    element('label', { class: 'visually-hidden', for: id, text: 'Search studies' }),
    search,
    list,
    none,
  );
  let last = [[], null, null];
  search.addEventListener('input', () => show(...last));
  return { node, show };

  function show(studies, chosen, running) {
    last = [studies, chosen, running];
    const words = search.value.trim().toLowerCase();
    const some = studies.filter(({ name, title, file }) =>
      `${name} ${title || ''} ${file}`.toLowerCase().includes(words),
    );
    const focused = list.contains(document.activeElement) ? document.activeElement.dataset.file : null;
    replace(
      list,
      some.map((study) => entry(study, chosen, running, onchoose)),
    );
    none.hidden = some.length > 0 || studies.length === 0;
    if (focused) [...list.querySelectorAll('button')].find((button) => button.dataset.file === focused)?.focus();
  }
}
