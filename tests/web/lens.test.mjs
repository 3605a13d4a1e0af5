// The report on a lens: the page's numbers are those of the command, it is renewed after a change of the scene, and a
// scene without lenses offers some.
import { readFileSync } from 'node:fs';
import { cp, writeFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const lenses = join(dirname(fileURLToPath(import.meta.url)), '..', '..', 'experiments', 'lenses');
const EXAMPLES = { 'Cemented achromat': 'cemented-achromat.csv', 'Cooke triplet': 'cooke-triplet.csv' };

const panelOf = (screen) => screen.page.getByRole('tabpanel', { name: 'Lens' });

/** Waits until the report of the present scene is shown. */
const renewed = (screen) => screen.page.locator('.lens-report[aria-busy="false"]:not(.stale) .plot').first().waitFor();

/** The report of the command on the scene of the page. */
async function commandReport(lab, ...options) {
  const { bytes } = await lab.ask('GET', '/api/scene.yaml');
  await writeFile(join(lab.folder, 'now.yaml'), bytes);
  return JSON.parse(await lab.run('lens', 'report', 'now.yaml', '--json', ...options));
}

/** The first-order data of the page. */
const firstOrder = (screen) =>
  panelOf(screen)
    .locator('.lens-first dd')
    .evaluateAll((all) => all.map((each) => each.textContent.split(' ')[0]));

/** The rows of a table of the page, by its caption. */
const tableOf = (screen, caption) =>
  panelOf(screen)
    .getByRole('table', { name: caption })
    .evaluate((table) => [...table.tBodies[0].rows].map((row) => [...row.cells].map((cell) => cell.textContent)));

const numberOf = (text) => Number(text.replace('−', '-').replace('–', 'NaN'));

/** How far two reports differ, relative to the largest number of a column. */
function difference(a, b) {
  let most = 0;
  for (const [name, { values }] of Object.entries(a.sections))
    for (const [key, column] of Object.entries(values)) {
      const [one, two] = [column, b.sections[name].values[key]].map((list) => [list].flat());
      const size = Math.max(1e-9, ...one.map((value) => Math.abs(value ?? 0)));
      if (one.length !== two.length) return Infinity;
      one.forEach((value, i) => {
        if ((value === null) !== (two[i] === null)) most = Infinity;
        else if (value !== null) most = Math.max(most, Math.abs(value - two[i]) / size);
      });
    }
  return most;
}

/** The tables of the page against a report. */
async function compareTables(t, screen, { sections }, what) {
  const first = await firstOrder(screen);
  const values = Object.values(sections['first-order'].values);
  t.equal(first.length, values.length, `${what}: number of first-order data`);
  const worst = (shown, known) =>
    Math.max(...shown.map((text, i) => Math.abs(numberOf(text) - known[i]) / (Math.abs(known[i]) || 1)));
  t.less(worst(first, values), 1e-8, `${what}: first-order data`);
  const spots = await tableOf(screen, /^Spots and wavefronts/);
  const { lambda_nm: nm, rms_centroid: rms } = sections.spot.values;
  t.less(
    worst(
      spots.map((row) => row[2]),
      rms.filter((_, i) => nm[i] > 0 || new Set(nm).size > 2), // no rows for all wavelengths if there is one
    ),
    1e-8,
    `${what}: RMS of the spots`,
  );
  const sums = await tableOf(screen, /^Seidel sums by surface/);
  const last = sums.at(-1);
  t.less(
    worst([last[1], last[4]], [sections['seidel-sum'].values.S_I, sections['seidel-sum'].values.S_IV]),
    1e-5,
    `${what}: Seidel sums`,
  );
}

async function start(t, how) {
  const lab = await t.lab('tests/shadow.yaml');
  const screen = await t.open(lab, how);
  await screen.showPanel('Lens');
  return { lab, screen };
}

async function example(screen, label) {
  await panelOf(screen).getByRole('button', { name: label }).click();
  await renewed(screen);
}

/** Waits until the page has that generation of the scene; its image may still be rendered. */
const known = (screen, { generation }) => screen.until((g) => window.lab.scene.generation >= g, generation);

export const cases = {
  'a scene without lenses offers some; their reports are those of the command': async (t) => {
    for (const [label, file] of Object.entries(EXAMPLES)) {
      const { lab, screen } = await start(t);
      await panelOf(screen).getByText('A report needs lenses').waitFor();
      await t.axe(screen, 'a scene without lenses');
      await t.image(screen, `lens-none`);
      await example(screen, label);
      const command = await commandReport(lab);
      const served = await lab.get('/api/lens');
      t.equal(served.lens, command.lens, `${label}: title`);
      t.less(difference(command, served), t.engine === 'server' ? 1e-15 : 1e-6, `${label}: the reply and the command`);
      await compareTables(t, screen, command, label);
      // The example is the lens of the repository.
      const rows = readFileSync(join(lenses, file), 'utf8').replace(/^#.*\n/gm, '');
      const sent = await lab.post('/api/open', { lens: file, text: rows });
      await known(screen, sent);
      t.equal(await lab.get('/api/lens'), served, `${label}: the file of experiments/lenses has the same report`);
      await t.image(screen, `lens-${label}`);
    }
  },

  'a change of the scene renews the report, a move of the camera does not': async (t) => {
    const { lab, screen } = await start(t);
    await example(screen, 'Cooke triplet');
    const before = await firstOrder(screen);
    const asked = await screen.asked();
    const moved = await lab.post('/api/camera', { orbit: [5, 0] });
    await known(screen, moved);
    await screen.quiet();
    t.equal(asked.filter((path) => path.startsWith('/api/lens')).length, 0, 'requests after a move of the camera');
    await panelOf(screen).getByRole('checkbox', { name: 'after each change' }).uncheck();
    const name = (await lab.get('/api/scene')).params.find(({ path }) => path.endsWith('.radius_1')).path;
    const radius = await lab.value(name);
    const changed = await lab.post('/api/set', { set: { [name]: 1.02 * radius } });
    await known(screen, changed);
    await panelOf(screen).getByText('From an earlier state of the scene').waitFor();
    t.equal(await firstOrder(screen), before, 'the old report is shown and marked');
    await panelOf(screen).getByRole('checkbox', { name: 'after each change' }).check();
    await renewed(screen);
    const command = await commandReport(lab);
    await compareTables(t, screen, command, 'after the change');
    t.check(numberOf((await firstOrder(screen))[0]) !== numberOf(before[0]), 'another focal length');
    for (const [label, words] of [
      ['Fields', '0, 7'],
      ['Wavelengths, nm', '550; 480 650'],
    ]) {
      const box = panelOf(screen).getByRole('textbox', { name: label });
      await box.fill(words);
      await box.press('Enter');
      await renewed(screen);
    }
    const other = await commandReport(lab, '--field', '0,7', '--wavelength', '550,480,650');
    await compareTables(t, screen, other, 'other fields and wavelengths');
    const shown = () =>
      panelOf(screen)
        .locator('.plot-dots')
        .evaluateAll((all) => all.filter((each) => each.getAttribute('d')).length);
    t.equal(await shown(), 6, 'spots of two fields and three wavelengths');
    await panelOf(screen).getByRole('combobox', { name: 'Show' }).selectOption('480');
    t.equal(await shown(), 2, 'spots of one wavelength');
  },

  'a coating is a design or layers': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Parameters');
    await screen.page.getByRole('searchbox', { name: /Find a parameter/ }).fill('grey.coating');
    const row = screen.page.locator('.param[data-path="grey.coating"]').first();
    const select = row.getByRole('combobox');
    const coating = async (act) => {
      const { generation } = await lab.get('/api/state');
      await act();
      await screen.until((g) => window.lab.newestGeneration > g, generation);
      await screen.until(() => window.lab.change.idle());
      return lab.value('grey.coating');
    };
    t.equal(await coating(() => select.selectOption('ar-550')), 'ar-550', 'a design');
    await t.axe(screen, 'a coating');
    t.equal(await coating(() => select.selectOption('own layers')), 'mgf2 550/4', 'its layers');
    const layers = row.getByRole('textbox');
    await layers.fill('mgf2 99, tio2 550/2');
    t.equal(await coating(() => layers.press('Enter')), 'mgf2 99, tio2 550/2', 'other layers');
    t.equal(await select.inputValue(), 'own layers', 'the choice of layers');
    await coating(() => select.selectOption('none'));
    t.check(await layers.isHidden(), 'no layers');
  },

  'files of lenses': async (t) => {
    const { lab, screen } = await start(t);
    const refused = await lab.ask('POST', '/api/open', { lens: 'bad.csv', text: 'radius,thickness\n1,x\n' });
    t.equal(refused.status, 400, 'status of a wrong file');
    const reply = JSON.parse(new TextDecoder().decode(refused.bytes));
    t.equal([reply.file, reply.line, reply.column], ['bad.csv', 2, 3], 'the place of the error');
    await panelOf(screen).locator('input[type=file]').setInputFiles(join(lenses, 'landscape.csv'));
    await renewed(screen);
    const csv = new TextDecoder().decode((await lab.ask('GET', '/api/lens.csv')).bytes).split('\n');
    t.equal(csv[0], 'section,surface,field,lambda_nm,x,quantity,value,unit', 'the head of the CSV');
    t.equal((await lab.ask('GET', '/api/lens?field=0,x')).status, 400, 'wrong fields');
    t.equal((await lab.ask('GET', '/api/lens?system=nothing')).status, 400, 'an unknown system');
  },

  'lens files of the folder': async (t) => {
    if (t.engine !== 'server') return t.check(true, 'the folder is in the page');
    const lab = await t.lab('tests/shadow.yaml');
    await cp(join(lenses, 'cooke-triplet.csv'), join(lab.folder, 'triplet.csv'));
    await writeFile(join(lab.folder, 'curve.csv'), 'nm,n\n500,1.5\n');
    const { lenses: listed, data } = await lab.get('/api/files');
    t.equal(
      [listed, data.includes('triplet.csv'), data.includes('curve.csv')],
      [['triplet.csv'], false, true],
      'lists',
    );
    const screen = await t.open(lab);
    await lab.post('/api/open', { file: 'triplet.csv' });
    await screen.showPanel('Lens');
    await renewed(screen);
    t.equal((await lab.get('/api/state')).file, null, 'a lens file is not the file of the scene');
    await t.axe(screen, 'a report');
    return undefined;
  },

  'on a telephone, and dark': async (t) => {
    const { screen } = await start(t, { width: 390, height: 844, touch: true, dark: true });
    await example(screen, 'Cooke triplet');
    const wide = await panelOf(screen).evaluate((node) => node.scrollWidth - node.clientWidth);
    t.equal(wide, 0, 'px beyond the width');
    await t.axe(screen, 'a report on a telephone');
    await t.image(screen, 'lens-phone');
  },
};
