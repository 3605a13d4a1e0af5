// A fan of rays and the scene's optics next to theory: the files are those of `cuvette fan` and `cuvette realism`, the
// focus of a ball is that of the closed form, and the panel Bench shows both and follows the scene.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

const SCENE = 'scenes/rod.yaml';
// The last digits of sines differ: the module has the C library of emscripten.
const NUMBER = /-?\b\d+(\.\d+)?(e[+-]?\d+)?/g;

const text = (reply) => Buffer.from(reply.bytes).toString();
const part = (screen, name) =>
  screen.page
    .getByRole('tabpanel', { name: 'Bench' })
    .locator('details')
    .filter({
      has: screen.page.locator('.group-title', { hasText: name }),
    });

async function refused(t, lab, path, code, words) {
  const reply = await lab.ask('GET', path);
  t.equal(reply.status, code, path);
  t.match(text(reply), words, path);
}

/** The segments of the fan over the image. */
const paths = (screen) => screen.page.locator('.layer-bench .bench-fan-ray');

export const cases = {
  'a fan is that of the command line': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/set', { set: { 'rod.visible': 'off' } });
    const command = ['fan', SCENE, '--from', '-3,1.5,0', '--to', '3,1.5,0', '--rays', '41', '--set', 'rod.visible=off'];
    const query = 'from=-3,1.5,0&to=3,1.5,0&rays=41';
    for (const [size, words, more] of [
      ['width=1.6', ['--width', '1.6'], ''],
      ['spread=30', ['--spread', '30', '--plane', '0,0,1', '--tree'], '&plane=0,0,1&tree=1'],
    ])
      for (const ending of ['csv', 'svg']) {
        await lab.run(...command, ...words, '-o', `fan.${ending}`);
        const written = await readFile(join(lab.folder, `fan.${ending}`), 'utf8');
        const reply = await lab.ask('GET', `/api/fan.${ending}?${query}&${size}${more}`);
        t.check(written.length > 1000 && text(reply) === written, `fan.${ending} with ${size} differs`);
      }

    const fan = await lab.get(`/api/fan?${query}&width=1.6`);
    const rows = text(await lab.ask('GET', `/api/fan.csv?${query}&width=1.6`))
      .trim()
      .split('\n')
      .slice(1);
    t.equal(
      fan.rays.map((ray) => [ray.offset, ray.interfaces, ray.end, ray.deviation_deg]),
      rows.map((row) => row.split(',')).map((row) => [Number(row[1]), Number(row[2]), row[3], Number(row[10])]),
      'offsets, interfaces, ends and deviations',
    );
    t.equal([fan.rays.length, fan.followed], [41, 41], 'rays');
    t.check(fan.crossings.length > 20 && fan.focus.at[0] > 0 && !fan.focus.virtual, 'a focus behind the vessel');
  },

  'the focus of a ball of glass': async (t) => {
    const lab = await t.lab();
    const name = (await lab.post('/api/objects', { kind: 'solid', shape: 'sphere' })).name;
    const [n, radius] = [1.5, 2];
    await lab.post('/api/set', {
      set: {
        [`${name}.position`]: [10, 20, 30],
        [`${name}.radius`]: radius,
        [`${name}.transparency`]: 1,
        [`${name}.ior`]: n,
      },
    });
    const fan = await lab.get('/api/fan?from=0,20,30&to=10,20,30&rays=5&width=0.0002');
    t.less(
      Math.abs(fan.focus.at[0] - 10 - (n * radius) / (2 * (n - 1))),
      1e-6,
      'error of the paraxial focus, n r/2(n-1)',
    );
    t.less(Math.abs(fan.rays[0].axis_at - fan.focus.at[0]), 1e-6, 'error of a crossing of the axis');
  },

  'wrong fans and curves are refused': async (t) => {
    const lab = await t.lab(SCENE);
    const query = '/api/fan?from=-3,1.5,0&to=3,1.5,0';
    await refused(t, lab, `${query}&rays=5`, 400, /width or spread is missing.*width=W/);
    await refused(t, lab, `${query}&rays=5&width=1&spread=2`, 400, /exclude each other/);
    await refused(t, lab, `${query}&rays=1001&width=1`, 400, /give 1 to 1000 rays/);
    await refused(t, lab, `${query}&rays=5&spread=180`, 400, /give 0 to 179 degrees/);
    await refused(t, lab, '/api/fan?from=1,2&to=3,1.5,0&rays=5&width=1', 400, /from is not 3 numbers: '1,2'/);
    await refused(t, lab, '/api/fan?from=3,1.5,0&to=3,1.5,0&rays=5&width=1', 400, /error/);
    await refused(t, lab, '/api/realism/rays', 404, /no curve of that name/);
    await refused(t, lab, '/api/realism/prism', 400, /prism.yaml/);
  },

  'metrics and curves are those of the command line': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/set', { set: { 'liquid.ior': 1.45 } });
    const set = ['--set', 'liquid.ior=1.45'];
    const written = (content) => (t.engine === 'server' ? content : content.replaceAll(NUMBER, '#'));
    const { curves, ...json } = await lab.get('/api/realism');
    const said = JSON.parse(await lab.run('realism', SCENE, '--json', ...set));
    t.equal(written(JSON.stringify(json)), written(JSON.stringify(said)), 'JSON');
    t.equal(json.passed, said.passed, 'metrics that pass');
    t.equal(curves.length, 9, 'curves of the vessel');
    const csv = await lab.run('realism', SCENE, '--csv', ...set);
    t.equal(written(text(await lab.ask('GET', '/api/realism.csv'))), written(csv), 'CSV');
    for (const name of ['mirror', 'deviation']) {
      const curve = await lab.run('realism', SCENE, '--curve', name, ...set);
      t.equal(written(text(await lab.ask('GET', `/api/realism/${name}/points.csv`))), written(curve), `CSV of ${name}`);
      const { points } = await lab.get(`/api/realism/${name}`);
      const rows = curve.trim().split('\n').slice(1);
      t.equal(points.length, rows.length, `points of ${name}`);
      const off = rows.map((row, i) => Math.max(...row.split(',').map((x, column) => Math.abs(x - points[i][column]))));
      t.less(Math.max(...off), t.engine === 'server' ? 1e-300 : 1e-9, `largest difference of the points of ${name}`);
    }
    await lab.post('/api/open', { file: 'scenes/prism.yaml' });
    t.equal(
      (await lab.get('/api/realism')).curves.map(({ name }) => name),
      ['prism'],
      'curves of the prism',
    );
  },

  'the panel traces a fan, draws it over the image and follows the scene': async (t) => {
    const lab = await t.lab(SCENE);
    const screen = await t.open(lab, { width: 1366, height: 900 });
    await screen.showPanel('Bench');
    const fan = part(screen, 'Fan of rays');
    await fan.locator('summary').click();
    await fan.getByRole('button', { name: 'Trace' }).click();
    await fan.getByText('21, ').waitFor();
    await screen.quiet();
    t.more(await paths(screen).count(), 40, 'segments over the image');
    const before = await fan.locator('dl').innerText();
    const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.1, 'rod.visible': 'off' } });
    await screen.settled(generation);
    await screen.quiet();
    t.check((await fan.locator('dl').innerText()) !== before, 'the numbers follow the scene');
    await fan.getByText('From one point').click();
    await fan.getByRole('spinbutton', { name: 'Angle' }).waitFor();
    await screen.quiet();
    t.match(await fan.locator('img').getAttribute('data-path'), /spread=20/, 'the drawing is that of the form');
    await fan.scrollIntoViewIfNeeded();
    await t.axe(screen, 'the fan');
    await t.image(screen, 'bench-fan');
    const [saved] = await Promise.all([
      screen.page.waitForEvent('download'),
      fan.getByRole('button', { name: 'Save table' }).click(),
    ]);
    t.equal(saved.suggestedFilename(), 'rod-fan.csv', 'name of the table');
    await screen.button('Close: Fan of rays').click();
    t.equal(await paths(screen).count(), 0, 'segments after closing');
  },

  'the panel shows metrics and a curve next to theory': async (t) => {
    for (const dark of [false, true]) {
      const lab = await t.lab(SCENE);
      const screen = await t.open(lab, { width: 1366, height: 900, dark });
      await screen.showPanel('Bench');
      const theory = part(screen, 'Optics and theory');
      await theory.locator('summary').first().click();
      await theory.getByRole('button', { name: 'Measure' }).click();
      await theory.getByText('35 of 35 pass').waitFor();
      await theory.locator('svg.plot').waitFor();
      await theory.getByRole('combobox', { name: 'Curve' }).selectOption('mirror');
      await screen.quiet();
      await theory.scrollIntoViewIfNeeded();
      await t.axe(screen, 'optics and theory');
      await t.image(screen, `bench-theory-${dark ? 'dark' : 'light'}`);
      const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.4 } });
      await screen.settled(generation);
      await theory.getByText('From an earlier state of the scene').waitFor();
      screen.expect(/400/);
      await lab.post('/api/open', { file: 'scenes/solids.yaml' });
      await screen.until(() => window.lab.state.file === 'scenes/solids.yaml');
      await screen.quiet();
      await theory.getByRole('button', { name: 'Measure' }).click();
      await theory.getByText("there is no visible cup named 'vessel'").waitFor();
    }
  },
};
