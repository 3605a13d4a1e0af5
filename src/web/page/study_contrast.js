/* The answer to a comparison of two sides of a study: the verdict in words, a chart of ratios and a table.
 * exports: createContrast() -> {node, show({answer, title, paths, runs, advice}), clear()}
 *   paths: axes in which both sides agree; runs: the sides are runs, so their films must agree; advice: what to do for
 *   a verdict if the sides did not alternate */

import { count, digits, element, notice, replace, timeUnit } from './ui.js';
import { createChart } from './study_chart.js';
import { createSortTable } from './study_table.js';

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
  const interval = low === null ? '' : ` (95% interval ${digits(low, 3)} to ${digits(high, 3)})`;
  const many = cells.length > 1;
  const measured = runs
    ? `${both.length} of ${cells.length} cells were measured in both runs; `
    : `${both.length} of ${cells.length} pairs of cells were measured; `;
  return (
    `${many ? measured : ''}B takes ${digits(ratio, 3)} times as long as A${many ? ' in the geometric mean' : ''}` +
    `${interval}. Verdict: ${verdict}${reason ? `, because ${reason}` : ''}.`
  );
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
      ? element('p', { text: `${count(all.pairs_needed)} processes of each side, in turn, find a difference of 3%.` })
      : null,
    others
      ? notice(`${others} ${others === 1 ? 'cell has' : 'cells have'} different films: the rendered images differ.`, {
          kind: 'warning',
        })
      : null,
  ];
}

export function createContrast() {
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
