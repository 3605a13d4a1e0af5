/* A chart of a study's cells with controls for its axes, and the same data as a table.
 * exports: createChart({caption, id}) -> {node, show({title, cells(quantity), quantities, paths, mark, note}),
 * chosen(): {quantity, x, by, logX, logY} of the chart; null: none, or automatic} */

import { say, translated } from '../shared/language.js';
import { plot } from '../shared/plot.js';
import { checkbox, choice, digits, element, empty, group, replace, table, timeUnit } from '../shared/ui.js';
import { axesFor, seriesOf } from './data.js';

const BY_MAX = 12; /* lines of a figure that `cuvette study plot` can distinguish */
const withUnit = (name, unit) => (unit ? `${name} / ${unit}` : name);
const spread = (values) => {
  const some = values.filter((value) => Number.isFinite(value));
  return some.length && Math.min(...some) > 0 ? Math.max(...some) / Math.min(...some) : 0;
};

/* Times in s, ms or µs, whichever the largest needs. */
function inOwnUnit(quantity, cells) {
  if (quantity.unit !== 's') return { quantity, cells };
  const { unit, factor } = timeUnit(cells.map(({ y }) => y));
  const times = (value) => value * factor;
  return {
    quantity: { ...quantity, unit },
    cells: cells.map((cell) => ({ ...cell, y: times(cell.y), low: times(cell.low), high: times(cell.high) })),
  };
}

function numbers(series, x, quantity, caption) {
  const rows = series.flatMap(({ name, points }) =>
    points.map((point) => [
      point.text || '–',
      name || '–',
      digits(point.y, 5),
      digits(point.low, 5),
      digits(point.high, 5),
    ]),
  );
  const right = (label) => ({ label, numeric: true });
  return table({
    caption,
    columns: [x || 'cell', 'line', right(withUnit(quantity.label, quantity.unit)), right('low'), right('high')],
    rows,
  });
}

export function createChart({ caption, id }) {
  const chosen = { quantity: null, x: null, logX: null, logY: null };
  const bar = element('div', { class: 'study-choices' });
  const place = element('figure', { class: 'study-plot', tabindex: '0', 'aria-label': caption });
  const below = element('div', { class: 'study-numbers' });
  const alternative = group('Chart data as a table', { open: false, id }, below);
  const node = element('div', { class: 'study-chart' }, bar, place, alternative);
  let what = null;
  let axesShown = {};
  let barOf = '';
  return {
    node,
    show(next) {
      what = next;
      draw();
    },
    chosen: () => ({ ...chosen, ...axesShown }),
  };

  function pick(key, value) {
    chosen[key] = value;
    if (key === 'quantity') chosen.logY = null;
    if (key === 'x') chosen.logX = null;
    barOf = '';
    draw();
  }

  /* Rebuilds the controls only when their choices change: an open list must not close when rows arrive. */
  function choices(quantity, x, axes, log) {
    const now = JSON.stringify([what.quantities.map(({ key }) => key), axes, quantity.key, x, log]);
    if (now === barOf) return;
    const focused = [...bar.querySelectorAll('select, input')].indexOf(document.activeElement);
    barOf = now;
    replace(
      bar,
      what.quantities.length > 1
        ? choice({
            label: 'Quantity',
            choices: what.quantities.map(({ key, label }) => [key, label]),
            value: quantity.key,
            onchange: (value) => pick('quantity', value),
          }).node
        : null,
      axes.length > 1
        ? choice({
            label: 'Horizontal axis',
            choices: axes.map(({ path }) => path),
            value: x,
            onchange: (value) => pick('x', value),
          }).node
        : null,
      checkbox('Logarithmic x axis', log.x, (on) => pick('logX', on)).node,
      checkbox('Logarithmic y axis', log.y, (on) => pick('logY', on)).node,
    );
    if (focused >= 0) bar.querySelectorAll('select, input')[focused]?.focus();
  }

  function draw() {
    const asked = what.quantities.find(({ key }) => key === chosen.quantity) || what.quantities[0];
    /* Includes unmeasured cells, so that each line keeps its style. */
    const { quantity, cells } = asked ? inOwnUnit(asked, what.cells(asked)) : { quantity: null, cells: [] };
    bar.hidden = alternative.hidden = !cells.some(({ y }) => Number.isFinite(y));
    if (bar.hidden) {
      replace(place, empty('No data to draw yet.'));
      return;
    }
    const axes = axesFor(cells, what.paths);
    const axis = axes.find(({ path }) => path === chosen.x) || axes[0];
    const { series, values, heading, omitted } = seriesOf(cells, what.paths, axis?.path);
    const others = axes.filter((one) => one !== axis);
    axesShown = { x: axis?.path ?? null, by: others.length === 1 && series.length <= BY_MAX ? others[0].path : null };
    const log = {
      x: chosen.logX ?? (!values && spread(series.flatMap((one) => one.points.map((point) => point.x))) >= 30),
      y: chosen.logY ?? spread(cells.map(({ y }) => y)) >= 50,
    };
    log.x &&= !values && series.every((one) => one.points.every((point) => point.x > 0));
    choices(quantity, axis?.path, axes, log);
    const title = `${what.title}: ${quantity.label}`;
    const few =
      quantity.low >= 0 && !cells.some(({ low }) => Number.isFinite(low))
        ? 'Intervals of the median require at least six rows per cell.'
        : '';
    replace(
      place,
      plot({
        title,
        series,
        heading,
        mark: what.mark,
        x: { label: withUnit(axis?.path || '', axis?.unit), log: log.x, values },
        y: { label: withUnit(quantity.label, quantity.unit), log: log.y },
      }),
      element('figcaption', {
        class: 'hint',
        text: [what.note, few, omitted ? say('{n} more lines are not drawn; see the summary.', { n: omitted }) : '']
          .filter(Boolean)
          .map(translated)
          .join(' '),
      }),
    );
    replace(below, numbers(series, axis?.path, quantity, caption));
  }
}
