// The table of a clicked pixel's rays equals the tree that `cuvette trace` prints for the same scene and pixel.
import { writeFile } from 'node:fs/promises';
import { join } from 'node:path';

const ends = {
  hit: 'hits a surface',
  sky: 'background',
  cut_depth: 'cut off: depth limit',
  cut_weight: 'cut off: weight too small',
  lit: 'unoccluded',
  blocked: 'blocked',
};
const degrees = (cosine) => (Math.acos(Math.min(1, cosine)) * 180) / Math.PI;
const channels = (c) => (c[0] === c[1] && c[1] === c[2] ? [c[0]] : c);

/** The rays of a tree from the root, each before its children. */
const flat = (node) => [node, ...node.children.flatMap(flat)];

/** The expected values of a row, by column header. */
function wanted({ depth, medium, n, throughput, contribution, hit }) {
  const row = {
    Depth: [depth],
    Weight: channels(throughput),
    Contribution: contribution.some((x) => x !== 0) ? channels(contribution) : [],
  };
  if (!hit) return { ...row, Media: [n], Angles: [], Path: [], medium };
  return {
    ...row,
    medium: hit.from.medium,
    Media: hit.opaque ? [hit.from.n] : [hit.from.n, hit.to.n],
    Angles: hit.opaque || hit.tir ? [degrees(hit.cos_i)] : [degrees(hit.cos_i), degrees(hit.cos_t)],
    R: hit.opaque || hit.tir ? null : [100 * hit.R],
    T: hit.opaque || hit.tir ? [] : [100 * hit.T],
    'R_s, R_p': hit.opaque || hit.tir ? [] : [hit.R_s, hit.R_p].map((share) => 100 * share),
    Path: [hit.path_length],
  };
}

const numbers = (text) => (text.replaceAll('\u2212', '-').match(/-?\d+(\.\d+)?(e-?\d+)?/g) ?? []).map(Number);

/** The visible rows, as {head: text}. */
const rowsOf = (screen) =>
  screen.page.getByRole('treegrid', { name: 'Rays of the pixel' }).evaluate((table) => {
    const heads = [...table.tHead.rows[0].cells].map((cell) => cell.innerText.trim());
    return [...table.tBodies[0].rows].map((row) => ({
      level: Number(row.getAttribute('aria-level')),
      ...Object.fromEntries([...row.cells].map((cell, i) => [heads[i], cell.textContent.trim()])),
    }));
  });

function compareRow(t, row, node, what) {
  const want = wanted(node);
  t.match(row.Media, new RegExp(`^(in )?${want.medium}\\b`), `${what}: medium`);
  t.equal(row.End, ends[node.end], `${what}: end`);
  if (node.hit) t.check(row.Hits.startsWith(node.hit.solid), `${what}: hits ${row.Hits}, not ${node.hit.solid}`);
  for (const [head, values] of Object.entries(want)) {
    if (head === 'medium' || values === null) continue;
    const shown = numbers(row[head]);
    const same =
      shown.length === values.length && shown.every((x, i) => Math.abs(x - values[i]) <= 6e-3 * Math.abs(values[i]));
    t.check(same, `${what}, ${head}: ${JSON.stringify(row[head])}, not ${values}`);
  }
}

async function compareTree(t, screen, lab, x, y, what) {
  await writeFile(join(lab.folder, 'scenes', 'inspected.yaml'), (await lab.ask('GET', '/api/scene.yaml')).bytes);
  const { root, radiance } = JSON.parse(
    await lab.run('trace', 'scenes/inspected.yaml', '--pixel', `${x},${y}`, '--json'),
  );
  const tree = flat(root);
  await screen.until(
    ([count]) =>
      document.querySelector('.panel-pixel')?.getAttribute('aria-busy') === 'false' &&
      document.querySelectorAll('[role=treegrid] tbody tr').length > 0 &&
      window.lab.newestGeneration >= count,
    [0],
  );
  await screen.button('Open all').click();
  const rows = await rowsOf(screen);
  if (!t.equal(rows.length, tree.length, `${what}: rays`)) return;
  tree.forEach((node, i) => compareRow(t, rows[i], node, `${what}, ray ${i}`));
  const summary = await screen.page.getByRole('tabpanel', { name: 'Pixel' }).locator('dl').first().innerText();
  const shown = numbers(summary.split('\n').find((line) => line.includes('·')) ?? '');
  t.check(
    shown.length === 3 && shown.every((v, i) => Math.abs(v - radiance[i]) < 1e-3 * radiance[i]),
    `${what}: radiance ${shown}, not ${radiance}`,
  );
}

export const cases = {
  'clicked pixels have the trees of cuvette trace': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    await screen.chooseTool('Inspect');
    for (const [x, y] of [
      [400, 300],
      [330, 420],
      [90, 560],
      [20, 10],
    ]) {
      await screen.clickPixel(x, y);
      await screen.until(
        ([px, py]) =>
          [px, py].every(
            (v, i) => Number(document.querySelectorAll('.panel-pixel input[role=spinbutton]')[i].value) === v,
          ),
        [x, y],
      );
      await compareTree(t, screen, lab, x, y, `pixel ${x},${y}`);
    }
  },

  'a pixel that the depth limit cuts off says so, with a button that raises the depth': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await lab.post('/api/set', { set: { 'render.depth': 1, 'render.beyond': 'black' } });
    await screen.settled();
    await screen.showPanel('Pixel');
    const panel = screen.page.getByRole('tabpanel', { name: 'Pixel' });
    const ask = async (x, y) => {
      await panel.getByRole('spinbutton', { name: 'Pixel x' }).fill(String(x));
      await panel.getByRole('spinbutton', { name: 'y', exact: true }).fill(String(y));
      await panel.getByRole('spinbutton', { name: 'y', exact: true }).press('Enter');
    };
    await ask(330, 420);
    await panel.getByText(/end at the depth limit, 1, and are black there/).waitFor();
    await panel.getByRole('button', { name: 'Raise the depth to 3' }).click();
    await screen.until(() => window.lab.param('render.depth').value === 3);
    await ask(60, 100); // the sky
    await panel.getByText(/1 from the camera/).waitFor();
    t.equal(await panel.getByText(/end at the depth limit/).count(), 0, 'nothing is cut off in the sky');
  },

  'the table follows a change of the scene': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    await screen.chooseTool('Inspect');
    await screen.clickPixel(400, 300);
    const first = await rowsOf(screen);
    const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.7, 'render.depth': 3 } });
    await screen.settled(generation);
    await screen.quiet();
    await compareTree(t, screen, lab, 400, 300, 'index 1.7');
    t.check(JSON.stringify(first) !== JSON.stringify(await rowsOf(screen)), 'the table does not change with the scene');
  },

  'the pixel is chosen by keys': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Pixel');
    const [x, y] = [
      screen.page.getByRole('spinbutton', { name: 'Pixel x' }),
      screen.page.getByRole('spinbutton', { name: 'y', exact: true }),
    ];
    await x.fill('400');
    await x.press('Enter');
    await y.fill('300');
    await y.press('Enter');
    await screen.quiet();
    await compareTree(t, screen, lab, 400, 300, 'typed');
    await screen.stage.focus();
    await screen.chooseTool('Inspect');
    await screen.stage.focus();
    await screen.page.keyboard.press('ArrowRight');
    await screen.page.keyboard.press('Shift+ArrowDown');
    await screen.quiet();
    await compareTree(t, screen, lab, 401, 310, 'arrow keys');
  },
};
