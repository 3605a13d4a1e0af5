/* The screen of the bench: a rectangle that bins the power of the beams, as image and curve.
 * exports: createBenchScreen(lab, bench, changed) -> {node}; sets bench.screen = {corners} while it is shown */

import { say } from '../shared/language.js';
import { plot } from '../shared/plot.js';
import { createRenewal } from '../shared/renewal.js';
import { button, checkbox, count, digits, element, facts, notice, number, replace, toByte } from '../shared/ui.js';
import { add, length, times, unit } from '../shared/vectors.js';
import { pointAt } from './ray_tree.js';

const PARTS = [
  ['Centre x', 0],
  ['Centre y', 1.2],
  ['Centre z', 0],
  ['Normal x', 1],
  ['Normal y', 0],
  ['Normal z', 0],
  ['Width', 1],
  ['Height', 1],
  ['Columns', 64],
  ['Rows', 64],
  ['Rays', 2000],
];

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/* The corners, by the same axes as in src/render/inspect/beams.c; null for a normal of length 0. */
function cornersOf([x, y, z, nx, ny, nz, width, height]) {
  const normal = unit([nx, ny, nz]);
  if (!normal) return null;
  const level = cross([0, 1, 0], normal);
  const u = length(level) > 1e-9 ? unit(level) : [1, 0, 0];
  const v = cross(normal, u);
  const at = (a, b) => add([x, y, z], add(times(u, (a * width) / 2), times(v, (b * height) / 2)));
  return [at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)];
}

export function createBenchScreen(lab, bench, changed) {
  const values = PARTS.map(([, value]) => value);
  let placed = values.join();
  const result = element('div', { class: 'bench-result', 'aria-live': 'polite' });
  const fields = PARTS.map(([label, value], i) =>
    number({
      label,
      value,
      step: 'any',
      onchange: (next) => {
        values[i] = next;
        outline();
      },
    }),
  );
  const shown = checkbox('Show the screen in the image', false, outline);
  const renewal = createRenewal(lab, result, act);
  const expose = button('Expose', renewal.run, { small: true, kind: 'primary' });
  const across = button('Place across the chosen segment', place, { small: true });
  const node = element(
    'div',
    { class: 'bench-screen-form' },
    shown.node,
    element(
      'div',
      { class: 'bench-fields' },
      fields.map((field) => field.node),
    ),
    element('div', { class: 'buttons' }, expose, across),
    renewal.node,
    result,
  );
  return { node };

  function outline() {
    const corners = shown.input.checked ? cornersOf(values) : null;
    bench.screen = corners && { corners };
    if (values.join() !== placed) renewal.changed();
    placed = values.join();
    changed();
  }

  /* Places the screen across the middle of the chosen segment, but no farther from its start than the extent of the
   * hits, as for a segment that leaves the scene. */
  function place() {
    const { chosen } = bench;
    if (!chosen) {
      replace(result, notice('Choose a segment of a beam first: click it in the image with the tool Bench.'));
      return;
    }
    const normal = unit(chosen.line.along) || [1, 0, 0];
    const middle = pointAt(chosen.line, Math.min(chosen.line.end / 2, chosen.tree.reach));
    [...middle, ...normal].forEach((value, i) => {
      values[i] = Number(value.toPrecision(6));
      fields[i].set(values[i]);
    });
    shown.input.checked = true;
    outline();
  }

  async function act() {
    const [x, y, z, nx, ny, nz, width, height, columns, rows, rays] = values;
    shown.input.checked = true;
    outline();
    expose.disabled = true;
    try {
      const answer = await lab.get(
        `/api/beams/screen?centre=${x},${y},${z}&normal=${nx},${ny},${nz}&size=${width},${height}` +
          `&bins=${columns},${rows}&rays=${rays}`,
      );
      draw(answer, width);
      return true;
    } catch (error) {
      replace(result, notice(error.message, { kind: 'error', remedy: error.remedy }));
      return false;
    } finally {
      expose.disabled = false;
    }
  }

  function draw(answer, width) {
    const { columns, rows, bins, received, power, rays, hits } = answer;
    const sums = Array.from({ length: columns }, (_, i) => {
      let sum = 0;
      for (let row = 0; row < rows; row++) sum += bins[row * columns + i];
      return { x: ((i + 0.5) / columns - 0.5) * width, y: sum };
    });
    replace(
      result,
      facts([
        ['Rays', say('N = {rays} traced, {hits} crossings', { rays: count(rays), hits: count(hits) })],
        ['Power received', say('{part} of {all}', { part: digits(received, 6), all: digits(power, 6) })],
      ]),
      image(answer),
      plot({
        title: 'Power by column of the screen',
        x: { label: 'position across the screen, scene units' },
        y: { label: 'power' },
        series: [{ name: `N = ${count(rays)}`, points: sums.map((each) => ({ ...each, low: NaN, high: NaN })) }],
      }),
    );
  }
}

/* The image on the screen, scaled so that its largest channel value is 1. */
function image({ columns, rows, color }) {
  const canvas = element('canvas', {
    class: 'bench-image',
    width: columns,
    height: rows,
    role: 'img',
    'aria-label': 'Image on the screen, scaled to its brightest bin',
  });
  const most = color.reduce((a, b) => Math.max(a, b), 0) || 1;
  const context = canvas.getContext('2d');
  const image = context.createImageData(columns, rows);
  for (let i = 0; i < columns * rows; i++) {
    for (let k = 0; k < 3; k++) image.data[4 * i + k] = toByte(Math.max(0, color[3 * i + k]) / most);
    image.data[4 * i + 3] = 255;
  }
  context.putImageData(image, 0, 0);
  return canvas;
}
