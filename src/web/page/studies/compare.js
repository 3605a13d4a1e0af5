/* Compares two sides of a study as `cuvette study compare` does: two runs, two values of an axis, or two rows of the
 * summary.
 * exports: createCompare(lab) -> {node, show(study, details, results)} */

import { say, translated } from '../shared/language.js';
import { choice, count, digits, element, empty, notice, replace, timeUnit } from '../shared/ui.js';
import { createChart } from './chart.js';
import { pathsOf } from './data.js';
import { createSortTable } from './table.js';

const ROWS_MAX = 500; /* of a list */
const RUNS = 'runs';
const CELLS = 'cells';

const valuesOf = ({ columns, rows }, path) => [...new Set(rows.map((row) => row[columns.indexOf(path)]))];

/* The axes with more than one value, each with a parameter whose values are all different: [{path, paths, values}]. */
function axesOf(study, summary) {
  return study.axes
    .map(({ paths, count }) => {
      const path = paths.find((one) => valuesOf(summary, one).length === count);
      return { path, paths, values: path ? valuesOf(summary, path) : [] };
    })
    .filter(({ values }) => values.length > 1);
}

function cellChoices(study, { columns, rows }) {
  const paths = pathsOf(study).map(({ path }) => path);
  const cell = columns.indexOf('cell');
  const name = (row) => paths.map((path) => `${path} ${row[columns.indexOf(path)]}`).join(', ');
  const all = new Map(rows.map((row) => [row[cell], `${row[cell]}: ${name(row)}`]));
  return [...all].slice(0, ROWS_MAX);
}

/* What can be compared: [{key, label, a: choices or a text, b: choices, query(a, b), paths, runs, advice}]. */
function subjectsOf(study, details, results) {
  const runs = (details.runs || []).filter((run) => run !== results);
  const all = pathsOf(study);
  const subjects = [];
  if (runs.length)
    subjects.push({
      key: RUNS,
      label: 'Two runs',
      a: [[results, results]],
      b: runs.map((run) => [run, run]),
      query: (a, b) => ({ with: b }),
      paths: all,
      runs: true,
      advice: 'For a verdict, measure both in turn: cuvette study run --against=PROGRAM --processes=8.',
    });
  if (!details.summary) return subjects;
  const command = `cuvette study run --processes=8 ${study.file}`;
  const advice = say('For a verdict, measure A and B in turn in fresh processes: {command}.', { command });
  for (const { path, paths, values } of axesOf(study, details.summary))
    subjects.push({
      key: `value ${path}`,
      label: say('Values of {path}', { path }),
      a: values.map((value) => [value, value]),
      query: (a, b) => ({ a: `${path}=${a}`, b: `${path}=${b}` }),
      paths: all.filter((one) => !paths.includes(one.path)),
      advice,
    });
  const cells = cellChoices(study, details.summary);
  if (cells.length > 1)
    subjects.push({
      key: CELLS,
      label: 'Two rows of the summary',
      a: cells,
      query: (a, b) => ({ a: `cell=${a}`, b: `cell=${b}` }),
      paths: [],
      advice,
    });
  return subjects;
}

export function createCompare(lab) {
  const bar = element('div', { class: 'study-choices' });
  const contrast = createContrast();
  const node = element('div', { class: 'study-part' }, bar, contrast.node);
  const chosen = { key: null, a: null, b: null };
  let study = null;
  let subjects = [];
  let shown = '';
  let asked = 0;
  return { node, show };

  function show(next, details, results) {
    if (lab.study?.running && next.name === study?.name) return; /* requests disturb the measurement */
    const key = JSON.stringify([next.name, details.runs, details.rows]);
    if (key === shown) return;
    shown = key;
    if (next.name !== study?.name) Object.assign(chosen, { key: null, a: null, b: null });
    study = next;
    subjects = subjectsOf(study, details, results);
    draw();
  }

  function draw() {
    const subject = subjects.find(({ key }) => key === chosen.key) || subjects[0];
    if (!subject) {
      replace(bar);
      contrast.clear(empty('No rows to compare yet: measure two cells, or measure again into another results folder.'));
      return;
    }
    const { key, a, b = a } = subject;
    const has = (list, value) => list.some(([one]) => one === value);
    chosen.key = key;
    if (!has(a, chosen.a)) [[chosen.a]] = a;
    if (!has(b, chosen.b)) chosen.b = null;
    const select = (label, choices, of) =>
      choice({ label, choices, value: chosen[of] ?? '', onchange: (value) => pick(of, value || null) }).node;
    replace(
      bar,
      select(
        'Compare',
        subjects.map((one) => [one.key, one.label]),
        'key',
      ),
      select('A', a, 'a'),
      select('B', [['', 'Choose'], ...b], 'b'),
    );
    ask(subject);
  }

  function pick(of, value) {
    const at = [...bar.querySelectorAll('select')].indexOf(document.activeElement);
    chosen[of] = value;
    if (of === 'key') chosen.a = chosen.b = null;
    draw();
    bar.querySelectorAll('select')[at]?.focus();
  }

  async function ask(subject) {
    const number = ++asked;
    const { a, b } = chosen;
    const of = study;
    contrast.clear();
    if (b === null) return;
    try {
      const address = `/api/studies/${encodeURIComponent(of.name)}/compare?${new URLSearchParams(subject.query(a, b))}`;
      const answer = await lab.get(address);
      if (number === asked)
        contrast.show({ ...subject, answer, title: say('{title}: B is {b}, A is {a}', { title: of.title, a, b }) });
    } catch (error) {
      if (number === asked) contrast.clear(notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
  }
}

const text = (value) => (value === null || value === undefined ? 'NA' : String(value));
const sameness = (value) => (value === null ? 'NA' : value ? 'yes' : 'no');

const quantity = { key: 'ratio', label: 'wall time B / wall time A', unit: '' };

function rowsOf(answer, paths, runs) {
  const { unit, factor } = timeUnit(answer.cells.flatMap(({ a, b }) => [a.median, b.median]));
  const time = ({ median }) => (median === null ? null : median * factor);
  const columns = [
    ...(runs ? ['cell'] : ['cell A', 'cell B']),
    ...paths.map(({ path }) => path),
    `A / ${unit}`,
    'A n',
    `B / ${unit}`,
    'B n',
    'B / A',
    'low',
    'high',
    'verdict',
    'same film',
  ];
  const rows = answer.cells.map((cell) =>
    [
      ...(runs ? [cell.cell] : [cell.a.cell, cell.b.cell]),
      ...paths.map(({ path }) => cell[path]),
      time(cell.a),
      cell.a.n,
      time(cell.b),
      cell.b.n,
      cell.ratio,
      cell.low,
      cell.high,
      cell.reason ? `${cell.verdict}: ${cell.reason}` : cell.verdict,
    ]
      .map(text)
      .concat(sameness(cell.same_film)),
  );
  return [columns, rows];
}

function wordsOf({ cells, all }, both, runs) {
  const { ratio, low, high, verdict, reason } = all;
  const many = cells.length > 1;
  const about = {
    measured: both.length,
    all: cells.length,
    ratio: digits(ratio, 3),
    low: digits(low, 3),
    high: digits(high, 3),
    verdict: translated(verdict),
    reason: translated(reason),
  };
  const measured = runs
    ? say('{measured} of {all} cells were measured in both runs.', about)
    : say('{measured} of {all} pairs of cells were measured.', about);
  return [
    many && measured,
    many
      ? say('B takes {ratio} times as long as A in the geometric mean.', about)
      : say('B takes {ratio} times as long as A.', about),
    low !== null && say('95% interval: {low} to {high}.', about),
    reason ? say('Verdict: {verdict}, because {reason}.', about) : say('Verdict: {verdict}.', about),
  ]
    .filter(Boolean)
    .join(' ');
}

function verdict({ answer, runs, advice }) {
  const { cells, all } = answer;
  const others = runs ? cells.filter((cell) => cell.same_film === false).length : 0;
  const both = cells.filter((cell) => cell.ratio !== null);
  if (!both.length)
    return notice(runs ? 'No cell was measured in both runs.' : 'One side has no rows.', { kind: 'warning' });
  return [
    element('p', { text: wordsOf(answer, both, runs) }),
    all.alternate ? null : element('p', { class: 'hint', text: advice }),
    all.pairs_needed
      ? element('p', {
          text: say('{n} processes of each side, in turn, find a difference of 3%.', { n: count(all.pairs_needed) }),
        })
      : null,
    others
      ? notice(say('{n} cells have different films: the rendered images differ.', { n: others }), {
          kind: 'warning',
        })
      : null,
  ];
}

function createContrast() {
  const chart = createChart({ caption: 'Ratios of two sides', id: 'study-ratios' });
  const sorted = createSortTable({ caption: 'Two sides, cell by cell' });
  const node = element('div', { class: 'study-compare', 'aria-live': 'polite' });
  return {
    node,
    clear: (...instead) => replace(node, ...instead),
    show(what) {
      const { answer, title, paths, runs } = what;
      const cells = answer.cells.map((cell) => ({
        at: Object.fromEntries(paths.map(({ path }) => [path, cell[path]])),
        y: cell.ratio ?? NaN,
        low: cell.low ?? NaN,
        high: cell.high ?? NaN,
      }));
      replace(node, verdict(what), cells.length > 1 ? chart.node : null, sorted.node);
      chart.show({
        title,
        paths,
        quantities: [quantity],
        cells: () => cells,
        mark: 1,
        note: 'Ratios of typical wall times with 95% intervals.',
      });
      sorted.show(...rowsOf(answer, paths, runs));
    },
  };
}
