/* The data of a study's tables: parses numbers, classifies columns, and makes series for charts.
 *
 * exports:
 *   numberOf(text)                    NaN for NA and words
 *   isNumeric(column, rows, index)    whether all known values of the column are numbers; hashes are not
 *   pathsOf(study)                    [{path, unit}] of the grid
 *   unitOf(column)                    's' for times, 'B', 'rays', 'dB' or ''
 *   quantitiesOf(summary, paths)      [{key, label, unit, column, low, high}] that a chart can show
 *   cellsOf(summary, paths, quantity) [{at: {path: text}, y, low, high}]
 *   axesFor(cells, paths)             paths with more than one value, numbers first
 *   seriesOf(cells, paths, x)         {series: [{name, points}], values, heading, omitted}; values: words of a
 *                                     categorical axis; omitted: number of lines left out */

const SERIES_MAX = 14; /* lines of one chart */
const HASHES = /(^|_)(hash|definition|reference|film_expected|reference_film)$/;
const NAMES = {
  wall_s: 'wall time per frame',
  cpu_s: 'CPU time per frame',
  rays_total: 'rays per frame',
  noise_rms: 'noise of path tracing',
  cut_fraction: 'fraction of the light that was cut',
  imbalance: 'load imbalance of the workers',
  flip: 'FLIP error',
  error_rms: 'error against the reference, rms',
  build_s: 'time to build the hierarchies',
  motion_s: 'time of the motion',
  peak_rss_bytes: 'peak memory',
  psnr_db: 'PSNR against the reference',
  ssim: 'SSIM against the reference',
  others_fraction: 'fraction of the CPU used by other programs',
};
const NOT_SHOWN = new Set(['cell', 'n', 'marked', 'excluded', 'disturbed', 'undisturbed_n']);

export const numberOf = (text) =>
  text === undefined || text === null || text === '' || text === 'NA' ? NaN : Number(text);

export function isNumeric(column, rows, index) {
  return (
    !HASHES.test(column) &&
    rows.every((row) => row[index] === 'NA' || !Number.isNaN(numberOf(row[index]))) &&
    rows.some((row) => row[index] !== 'NA')
  );
}

export const pathsOf = (study) =>
  (study.axes || []).flatMap((axis) => axis.paths.map((path, i) => ({ path, unit: axis.units[i] })));

export function unitOf(column) {
  if (/_s(_|$)/.test(column)) return 's';
  if (/bytes$/.test(column)) return 'B';
  if (/^rays_|hits\./.test(column)) return 'rays';
  return column === 'psnr_db' ? 'dB' : '';
}

export function quantitiesOf(summary, paths) {
  const { columns, rows } = summary;
  const axisPaths = new Set(paths.map(({ path }) => path));
  const part = /_(low|high|mean|min|max)$/;
  return columns
    .map((column, i) => ({ column, i }))
    .filter(
      ({ column, i }) =>
        !axisPaths.has(column) &&
        !NOT_SHOWN.has(column) &&
        !(part.test(column) && columns.includes(column.replace(part, '_median'))) &&
        isNumeric(column, rows, i),
    )
    .map(({ column }) => {
      const key = column.replace(/_median$/, '');
      return {
        key,
        column,
        label: NAMES[key] || key,
        unit: unitOf(key),
        low: columns.indexOf(`${key}_low`),
        high: columns.indexOf(`${key}_high`),
      };
    });
}

export function cellsOf(summary, paths, quantity) {
  const { columns, rows } = summary;
  const value = columns.indexOf(quantity.column);
  return rows.map((row) => ({
    at: Object.fromEntries(paths.map(({ path }) => [path, row[columns.indexOf(path)]])),
    y: numberOf(row[value]),
    low: numberOf(row[quantity.low]),
    high: numberOf(row[quantity.high]),
  }));
}

const valuesOf = (cells, path) => [...new Set(cells.map((cell) => cell.at[path]))];

export function axesFor(cells, paths) {
  const some = paths.filter(({ path }) => valuesOf(cells, path).length > 1);
  const numeric = ({ path }) => valuesOf(cells, path).every((value) => !Number.isNaN(numberOf(value)));
  return [...some.filter(numeric), ...some.filter((one) => !numeric(one))];
}

/* Whether the value of `from` determines the value of `path`; `path` then does not distinguish lines. */
function follows(cells, path, from) {
  const seen = new Map();
  return cells.every((cell) => {
    if (!seen.has(cell.at[from])) seen.set(cell.at[from], cell.at[path]);
    return seen.get(cell.at[from]) === cell.at[path];
  });
}

export function seriesOf(cells, paths, x) {
  const apart = paths
    .map(({ path }) => path)
    .filter((path) => path !== x && valuesOf(cells, path).length > 1 && !follows(cells, path, x));
  const telling = apart.filter((path, i) => !apart.slice(0, i).some((other) => follows(cells, path, other)));
  const all = x ? valuesOf(cells, x) : ['all'];
  const words = all.some((value) => Number.isNaN(numberOf(value)));
  const lines = new Map();
  for (const cell of cells) {
    const name = telling.map((path) => cell.at[path]).join(', ');
    if (!lines.has(name)) lines.set(name, []);
    lines.get(name).push({
      x: words || !x ? Math.max(0, all.indexOf(cell.at[x])) : numberOf(cell.at[x]),
      text: x ? cell.at[x] : '',
      ...cell,
    });
  }
  const series = [...lines].map(([name, points]) => ({
    name,
    points: points.filter((point) => Number.isFinite(point.y)).sort((a, b) => a.x - b.x),
  }));
  return {
    series: series.slice(0, SERIES_MAX),
    omitted: Math.max(0, series.length - SERIES_MAX),
    values: words || !x ? all : null,
    heading: telling.length === 1 ? telling[0] : telling.map((path) => path.split('.').pop()).join(', '),
  };
}
