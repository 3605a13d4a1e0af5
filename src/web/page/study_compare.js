/* Compares two runs of a study cell by cell: a chart of ratios and a table. exports: createCompare(lab) -> {node,
 * show(study, details, results), forget()} */

import { choice, count, digits, element, empty, notice, replace } from './ui.js';
import { createChart } from './study_chart.js';
import { createSortTable } from './study_table.js';
import { pathsOf } from './study_data.js';

const text = (value) => (value === null || value === undefined ? 'NA' : String(value));
const sameness = (value) => (value === null ? 'NA' : value ? 'yes' : 'no');

const quantity = { key: 'ratio', label: 'wall time B / wall time A', unit: '' };

function rowsOf(answer) {
  const columns = [
    'cell',
    ...answer.columns,
    'A / s',
    'A n',
    'B / s',
    'B n',
    'B / A',
    'low',
    'high',
    'verdict',
    'same film',
  ];
  const rows = answer.cells.map((cell) =>
    [
      cell.cell,
      ...answer.columns.map((path) => cell[path]),
      cell.a.median,
      cell.a.n,
      cell.b.median,
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

function verdict({ cells, all }) {
  const others = cells.filter((cell) => cell.same_film === false).length;
  const both = cells.filter((cell) => cell.ratio !== null);
  if (!both.length) return notice('No cell was measured in both runs.', { kind: 'warning' });
  const { ratio, low, high, verdict: word, reason, pairs_needed: needed } = all;
  const interval = low === null ? '' : ` (95% interval ${digits(low, 3)} to ${digits(high, 3)})`;
  return [
    element('p', {
      text:
        `${both.length} of ${cells.length} cells were measured in both runs; B takes ` +
        `${digits(ratio, 3)} times as long as A in the geometric mean${interval}. Verdict: ${word}` +
        `${reason ? `, because ${reason}` : ''}.`,
    }),
    needed
      ? element('p', { text: `${count(needed)} processes of each side, in turn, find a difference of 3%.` })
      : null,
    others
      ? notice(`${others} ${others === 1 ? 'cell has' : 'cells have'} different films: the rendered images differ.`, {
          kind: 'warning',
        })
      : null,
  ];
}

export function createCompare(lab) {
  const bar = element('div');
  const below = element('div', { class: 'study-compare' });
  const chart = createChart({ caption: 'Ratios of two runs', id: 'study-ratios' });
  const sorted = createSortTable({ caption: 'Two runs, cell by cell' });
  const node = element('div', { class: 'study-part' }, bar, below);
  let shown = '';
  let other = '';
  return {
    node,
    show,
    forget() {
      shown = other = '';
    },
  };

  function show(study, details, results) {
    const runs = (details.runs || []).filter((run) => run !== results);
    const key = [study.name, ...runs].join('\n');
    if (key === shown) return;
    shown = key;
    if (!runs.includes(other)) other = '';
    if (!runs.length) {
      replace(
        bar,
        empty(
          `No other folder has rows of ${study.name}. Copy ${results || 'results'} to another folder before ` +
            `you measure again, then compare.`,
        ),
      );
      replace(below);
      return;
    }
    const choices = [['', 'Choose a run'], ...runs.map((run) => [run, run])];
    replace(
      bar,
      choice({ label: `A is ${results || 'results'}, B is`, choices, value: other, onchange: (run) => ask(study, run) })
        .node,
    );
    ask(study, other);
  }

  async function ask(study, run) {
    other = run;
    replace(below);
    if (!run) return;
    try {
      const answer = await lab.get(
        `/api/studies/${encodeURIComponent(study.name)}/compare?with=${encodeURIComponent(run)}`,
      );
      if (run === other) draw(study, answer, run);
    } catch (error) {
      if (run === other) replace(below, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
  }

  function draw(study, answer, run) {
    const paths = pathsOf(study);
    const cells = answer.cells.map((cell) => ({
      at: Object.fromEntries(paths.map(({ path }) => [path, cell[path]])),
      y: cell.ratio ?? NaN,
      low: cell.low ?? NaN,
      high: cell.high ?? NaN,
    }));
    replace(below, verdict(answer), chart.node, sorted.node);
    chart.show({
      title: `${study.title}, ${run} compared with the current results`,
      paths,
      quantities: [quantity],
      cells: () => cells,
      mark: 1,
      note: 'Ratios of typical wall times with 95% intervals.',
    });
    sorted.show(...rowsOf(answer));
  }
}
