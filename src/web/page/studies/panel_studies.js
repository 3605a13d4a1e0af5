/* The panel Studies: the list of studies and the selected one. While a study runs, the display is refreshed every few
 * seconds only: requests disturb the measurement. exports: panel */

import { say } from '../shared/language.js';
import { needsProgram } from '../shared/commands.js';
import { button, element, empty, icon, memory, replace, unique } from '../shared/ui.js';
import { createDetails } from './details.js';
import { createStudyForm } from './form.js';

const APART_MS = 3000;
let visible = false;
let refresh = () => undefined;

/* A browser's clock is too coarse, and its times would not be comparable with rows of the program. */
function createElsewhere(root, lab) {
  const place = element('div', { class: 'study-place study-elsewhere' });
  root.append(place);
  refresh = () =>
    replace(
      place,
      element('h2', { text: 'Studies' }),
      needsProgram(lab, 'Studies measure times with the program on a computer, not in a browser.', [
        (file) => `cuvette study new ${file} --axis render.depth=1,2,4,8 -o depth.study`,
        'cuvette study run depth.study',
        (file) => `cuvette lab ${file}`,
      ]),
    );
  lab.on('state', () => visible && refresh());
}

function create(root, lab) {
  if (lab.engine.kind === 'server') createStudies(root, lab);
  else createElsewhere(root, lab);
}

function createStudies(root, lab) {
  const list = createStudyList({ onchoose: choose });
  const details = createDetails(lab, { onrun: run, onstop: stop });
  const place = element('div', { class: 'study-place' }, empty('Reading the studies …'));
  let studies = [];
  let results = null;
  let chosen = memory.get('study', null);
  let fetchedAt = 0;
  let seen = { running: false, name: null };
  let fetched = -1;
  let asking = false;
  const form = createStudyForm(lab, { files: () => studies.map(({ file }) => file), onsaved: saved });
  root.append(
    element(
      'div',
      { class: 'study-side' },
      element(
        'div',
        { class: 'study-side-head' },
        element('h2', { text: 'Studies' }),
        button('New study', form.open, { icon: 'plus', small: true }),
        button('Refresh', () => refresh(), {
          icon: 'refresh',
          kind: 'quiet',
          small: true,
          title: 'read the study files again',
        }),
      ),
      list.node,
    ),
    place,
  );
  refresh = () => fetchStudies().catch(lab.fail);
  lab.on('study', follow);
  lab.on('state', () => follow(lab.study));
  lab.on('restarted', () => refresh());

  const path = (study, more = '') => `/api/studies/${encodeURIComponent(study.name)}${more}`;

  function choose(study) {
    chosen = study.file;
    memory.set('study', chosen);
    showList();
    fetchStudy().catch(lab.fail);
  }

  async function saved(file, start) {
    chosen = file;
    memory.set('study', chosen);
    lab.say(say('{name} saved.', { name: file }));
    try {
      await fetchStudies();
      const study = studies.find((each) => each.file === file);
      if (start && study) await run(study);
    } catch (error) {
      lab.fail(error);
    }
  }

  function showList() {
    list.show(studies, chosen, lab.study?.running ? lab.study : null);
  }

  async function fetchStudies() {
    const reply = await lab.get('/api/studies');
    ({ studies, results } = reply);
    if (!studies.some((study) => study.file === chosen))
      chosen = (studies.find((study) => !study.error) || studies[0])?.file ?? null;
    showList();
    if (!studies.length)
      replace(
        place,
        empty(
          'The folder contains no study. A study is a file NAME.study with a scene, a grid over its ' +
            'parameters, and repetitions; New study makes one.',
        ),
      );
    else await fetchStudy();
  }

  /* Ignores a late reply about another study. */
  async function fetchStudy() {
    const study = studies.find(({ file }) => file === chosen);
    if (!study) return;
    fetchedAt = Date.now();
    const reply = study.error && study.cells === undefined ? study : await lab.get(path(study));
    if (study.file !== chosen) return;
    Object.assign(study, reply.file === study.file ? reply : {});
    showList();
    details.show(study, reply, results);
    if (!place.contains(details.node)) replace(place, details.node);
  }

  async function run(study) {
    try {
      await lab.post(path(study, '/run'), {});
      lab.say(say('{name} is running; rendering is paused until it finishes.', study));
    } catch (error) {
      lab.fail(error);
    }
  }

  async function stop(study) {
    try {
      await lab.post(path(study, '/stop'), {});
    } catch (error) {
      lab.fail(error);
    }
  }

  /* Fetches the study again every few seconds during a run, and at the run's start and end. */
  async function follow(now) {
    if (!now) return;
    const begun = now.running && (!seen.running || seen.name !== now.name);
    const ended = seen.running && !now.running;
    seen = { running: now.running, name: now.name };
    if (ended)
      lab.say(now.error ? `${now.name}: ${now.error.error}` : say('{name} has ended; all rows are saved.', now));
    if (!visible) return;
    details.progress(now);
    if (begun || ended || now.running) showList();
    const due = now.frames_done !== fetched && Date.now() - fetchedAt >= APART_MS;
    if (!begun && !ended && (!due || asking)) return;
    asking = true;
    fetched = now.frames_done;
    try {
      await (ended ? fetchStudies() : fetchStudy());
      if (studies.find(({ file }) => file === chosen)?.name === now.name) details.grew(ended);
    } catch (error) {
      lab.fail(error);
    }
    asking = false;
  }
}

export const panel = {
  id: 'studies',
  title: 'Studies',
  wide: true,
  css: 'studies/panel_studies.css',
  create,
  shown() {
    visible = true;
    refresh();
  },
  hidden() {
    visible = false;
  },
};

/* --- the list: one button per study, with its progress --- */

const fractionOf = ({ frames_done: done, frames_all: all, fraction }) => (all ? (done + (fraction || 0)) / all : 0);

function state(study, running) {
  if (running) return say('running, {percent} %', { percent: Math.floor(100 * fractionOf(running)) });
  if (study.error) return 'cannot be read';
  if (study.cells_done >= study.cells) return 'complete';
  return study.rows
    ? say('{done} of {n} cells', { done: study.cells_done, n: study.cells })
    : say('{n} cells', { n: study.cells });
}

function entry(study, chosen, running, onchoose) {
  const now = running?.name === study.name && !study.error ? running : null;
  const value = now ? fractionOf(now) : study.cells ? study.cells_done / study.cells : 0;
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
        { class: 'study-entry-name', translate: 'no' },
        now ? icon('play') : study.error ? icon('warning') : study.cells_done >= study.cells ? icon('check') : null,
        study.name,
      ),
      element('span', { class: study.error ? 'study-entry-state bad' : 'study-entry-state', text: state(study, now) }),
      element('span', {
        class: 'study-entry-title',
        translate: 'no',
        text: study.error ? study.error.error : study.title,
      }),
      study.error
        ? null
        : element('progress', { max: 1, value: String(value), 'aria-label': say('{name}, done', study) }),
    ),
  );
}

function createStudyList({ onchoose }) {
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
