/* The details of one study: definition, progress, chart, tables and other runs. exports: createDetails(lab, {onrun,
 * onstop}) -> {node, show(study, details, results), progress(now), grew(ended)}; now: the study of the state */

import { say, translated } from '../shared/language.js';
import { saveReply } from '../shared/save_file.js';
import { button, checkbox, count, element, empty, facts, group, notice, replace, seconds } from '../shared/ui.js';
import { createChart } from './chart.js';
import { createCompare } from './compare.js';
import { cellsOf, pathsOf, quantitiesOf } from './data.js';
import { createFigures, createSave } from './figures.js';
import { createRows, createSortTable } from './table.js';

const FIRST =
  /^(cell|n|wall_s_(median|low|high)|cpu_s_median|rays_total|noise_rms|psnr_db|flip|film_hash|marked|excluded)$/;
const MEASURES = 'measures the missing rows; rendering is paused until it finishes';
const STARTS = {
  start: ['Start', MEASURES],
  continue: ['Continue', MEASURES],
  files: ['Make the missing files', 'all rows are measured; makes the missing images, maps and comparisons'],
  complete: ['Complete', 'all rows are measured'],
};
const stages = { measuring: 'measuring', moving: 'simulating the slime', images: 'rendering images' };

function axisWords({ name, paths, units, count: points }) {
  const list = paths.map((path, i) => (units[i] ? `${path} / ${units[i]}` : path)).join(', ');
  return say('{axis}: {n} values', {
    axis: paths.length === 1 && paths[0] === name ? list : `${name} (${list})`,
    n: points,
  });
}

/* The number of disturbed rows, which are kept and used. */
const warnings = ({ disturbed, rows, warmups }) =>
  disturbed
    ? notice(
        say(
          '{disturbed} of {rows} rows were measured while other programs ran, ' +
            'or with a lower frequency of the processor.',
          {
            disturbed: count(disturbed),
            rows: count(rows - warmups),
          },
        ),
        {
          kind: 'warning',
          remedy: 'Their times may be too long: close other programs, and measure again into another results folder.',
        },
      )
    : null;

const about = (study, details, results) =>
  facts(
    [
      ['File', study.file],
      [
        'Axes',
        study.axes.length
          ? element(
              'ul',
              { class: 'study-axes' },
              study.axes.map((axis) => element('li', { text: axisWords(axis) })),
            )
          : 'none',
      ],
      ['Cells', say('{done} of {all} done', { done: count(details.cells_done), all: count(details.cells) })],
      [
        'Rows',
        say('{rows}, of which {warmups} warm-ups', { rows: count(details.rows), warmups: count(details.warmups) }),
      ],
      results && details.rows ? ['Results', element('code', { text: `${results}/${study.name}` })] : null,
      details.marked
        ? ['Marked', say('{n} rows with another film than the first row of their cell', { n: count(details.marked) })]
        : null,
    ].filter(Boolean),
  );

/* The progress bar and a description of the current work. */
function createProgress() {
  const bar = element('progress', { max: 1, value: '0', 'aria-label': 'done' });
  const words = element('p', { class: 'study-now' });
  const node = element('div', { class: 'study-progress' }, bar, words);
  return {
    node,
    show(now) {
      node.hidden = !now?.running;
      if (node.hidden) return;
      const done =
        now.stage === 'images'
          ? (now.image - 1 + now.fraction) / now.images
          : now.frames_all
            ? (now.frames_done + now.fraction) / now.frames_all
            : 0;
      bar.value = done;
      words.textContent = [
        now.images
          ? say('image {image} of {images}', now)
          : say('{done} of {all} frames', { done: count(now.frames_done), all: count(now.frames_all) }),
        `${Math.floor(100 * done)} %`,
        now.images || now.left_s === null
          ? null
          : say('about {time} left', { time: seconds(Math.max(1, Math.round(now.left_s))) }),
        say('cell {cell}: {stage}', { cell: now.cell, stage: translated(stages[now.stage] || now.stage) }),
      ]
        .filter(Boolean)
        .join(' · ');
    },
  };
}

function createSummary(lab) {
  const sorted = createSortTable({ caption: 'Summary: one line per cell' });
  const all = checkbox('All columns', false, () => draw());
  const place = element('div', { class: 'study-part' });
  const save = button(
    'Save summary as TSV',
    () => saveReply(lab, `/api/studies/${encodeURIComponent(name)}/summary.tsv`, `${name}.tsv`),
    { icon: 'download', small: true, title: 'all columns, separated by tabs, as printed by cuvette study summary' },
  );
  let name = '';
  let summary = null;
  let paths = [];
  return {
    node: place,
    show(study, next, nextPaths) {
      name = study.name;
      summary = next;
      paths = nextPaths.map(({ path }) => path);
      draw();
    },
  };

  function draw() {
    if (!summary) {
      replace(place, empty('No rows to summarise yet.'));
      return;
    }
    const kept = summary.columns
      .map((column, i) => i)
      .filter((i) => all.value || paths.includes(summary.columns[i]) || FIRST.test(summary.columns[i]));
    const known = kept.filter((i) => all.value || summary.rows.some((row) => row[i] !== 'NA'));
    const pick = (row) => known.map((i) => row[i]);
    if (!place.contains(sorted.node)) replace(place, all.node, sorted.node, element('div', { class: 'buttons' }, save));
    sorted.show(pick(summary.columns), summary.rows.map(pick));
  }
}

export function createDetails(lab, { onrun, onstop }) {
  const heading = element('h2', { translate: 'no' });
  const start = button('Start', () => onrun(study), { icon: 'play', kind: 'primary' });
  const stop = button('Stop', () => onstop(study), { icon: 'stop' });
  const progress = createProgress();
  const trouble = element('div');
  const what = element('div');
  const chart = createChart({ caption: 'Chart of the study', id: 'study-figure-numbers' });
  const save = createSave(lab, chart.chosen);
  const summary = createSummary(lab);
  const rows = createRows(lab);
  const figures = createFigures(lab);
  const compare = createCompare(lab);
  const parts = element(
    'div',
    { class: 'study-groups' },
    group(
      'Chart',
      { id: 'study-figure', hint: 'medians with 95% intervals, updated during the run' },
      chart.node,
      save.node,
    ),
    group('Summary', { id: 'study-summary', hint: 'one line per cell' }, summary.node),
    rows.node,
    group('Figures of plots/', { id: 'study-drawn', hint: 'drawn by gnuplot' }, figures.node),
    group('Compare', { id: 'study-compare', hint: 'two runs, cells or values of a parameter' }, compare.node),
  );
  const node = element(
    'article',
    { class: 'study-details', 'aria-label': 'Study' },
    element('div', { class: 'study-head' }, heading, element('div', { class: 'buttons' }, start, stop)),
    progress.node,
    trouble,
    what,
    parts,
  );
  let study = null;
  let details = null;
  return { node, show, progress: showProgress, grew: (ended) => figures.grew(ended) };

  function show(next, reply, results) {
    study = next;
    details = reply;
    heading.textContent = study.title || study.name;
    const broken = details.error && details.cells === undefined;
    parts.hidden = broken;
    showProgress(lab.study);
    replace(what, broken ? null : [warnings(details), about(study, details, results)]);
    if (broken) return;
    const paths = pathsOf(study);
    chart.show({
      title: study.title,
      paths,
      quantities: details.summary ? quantitiesOf(details.summary, paths) : [],
      cells: (quantity) => cellsOf(details.summary, paths, quantity),
    });
    save.show(study, details.rows, running());
    summary.show(study, details.summary, paths);
    rows.show(study, details.rows);
    figures.show(study, details, running());
    compare.show(study, details, results);
  }

  function running() {
    return lab.study?.running && lab.study.name === study.name;
  }

  function showProgress(now) {
    if (!study) return;
    const mine = now?.name === study.name;
    progress.show(mine ? now : null);
    const other = now?.running && !mine ? now.name : null;
    start.hidden = Boolean(mine && now.running);
    stop.hidden = !start.hidden;
    const complete = details.cells > 0 && details.cells_done >= details.cells;
    const next = !complete ? (details.rows ? 'continue' : 'start') : details.lacks_files ? 'files' : 'complete';
    start.querySelector('.button-label').textContent = translated(STARTS[next][0]);
    start.classList.toggle('primary', !complete);
    start.disabled = next === 'complete' || Boolean(other) || (Boolean(details.error) && details.cells === undefined);
    start.title = other ? say('the study {name} is running', { name: other }) : translated(STARTS[next][1]);
    const error = details.error || (mine && now.error) || null;
    const where = error?.file ? `${error.file}${error.line ? `:${error.line}` : ''}: ` : '';
    if (trouble.dataset.of !== JSON.stringify(error)) {
      trouble.dataset.of = JSON.stringify(error);
      replace(trouble, error ? notice(`${where}${error.error}`, { kind: 'error', remedy: error.remedy }) : null);
    }
  }
}
