// A study is started on the page, watched, stopped half way and continued to its end; the page shows what the program
// prints.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

const CELLS = 16;
const ROWS = CELLS * 10;

const running = (screen, yes) => screen.until((on) => Boolean(window.lab.study?.running) === on, yes);

async function chosen(t) {
  const lab = await t.lab('scenes/rod.yaml');
  const screen = await t.open(lab, { width: 1600, height: 1000 });
  await screen.showPanel('Studies');
  await screen.page.getByRole('navigation', { name: 'Studies' }).getByRole('button', { name: /quick/ }).click();
  const study = screen.page.getByRole('article', { name: 'Study' });
  await study.getByRole('heading', { name: 'Time by recursion depth and index' }).waitFor();
  return { lab, screen, study };
}

const rowsOf = async (lab) =>
  (await readFile(join(lab.folder, 'results/quick/rows.csv'), 'utf8')).trim().split('\n').slice(1);
/** Without warm-up rows: a continued run warms up again. */
const measured = (rows) => rows.filter((row) => row.split(',')[4] === '0');

export const cases = {
  'started, stopped, continued to its end': async (t) => {
    const { lab, screen, study } = await chosen(t);
    screen.context.setDefaultTimeout(60000);
    await study.getByRole('button', { name: 'Start', exact: true }).click();
    await running(screen, true);
    await screen.until(() => window.lab.study.frames_done > 12);
    t.check((await lab.get('/api/state')).waiting, 'nothing is rendered meanwhile, and the state says why');
    await study.getByRole('progressbar').waitFor();
    await study.getByRole('button', { name: 'Stop', exact: true }).click();
    await running(screen, false);
    await screen.quiet();
    const some = await rowsOf(lab);
    t.more(some.length, 12, 'rows after it was stopped');
    t.check(measured(some).length < ROWS, `it was stopped before its end: ${measured(some).length} of ${ROWS} rows`);
    const plot = study.getByRole('img', { name: /Time by recursion depth and index/ });
    t.more(await plot.locator('.plot-marker').count(), 0, 'markers in its figure');

    await study.getByRole('button', { name: 'Continue' }).click();
    await running(screen, true);
    await running(screen, false);
    await screen.until(() => window.lab.study.frames_done === window.lab.study.frames_all);
    await screen.quiet();
    const all = await rowsOf(lab);
    t.equal(measured(all).length, ROWS, 'rows at the end');
    t.equal(all.slice(0, some.length), some, 'the rows from before are kept as they were');
    const told = await lab.get('/api/studies/quick');
    t.equal([told.cells_done, told.marked], [CELLS, 0], 'cells done, rows of another film');
    // One line per depth or index with four markers each, and one in the legend.
    t.equal(await plot.locator('.plot-series .plot-marker').count(), CELLS + 4, 'markers in its figure');
    await t.axe(screen, 'a study with rows');

    const summary = (await lab.run('study', 'summary', 'studies/quick.study'))
      .trim()
      .split('\n')
      .map((line) => line.split('\t'));
    t.equal(told.summary.columns, summary[0], 'columns of the summary');
    t.equal(told.summary.rows.length, summary.length - 1, 'lines of the summary');
    const table = study.getByRole('region', { name: 'Summary' }).getByRole('table');
    t.equal(await table.locator('tbody tr').count(), CELLS, 'lines of the summary in the page');
    const hashes = summary.slice(1).map((line) => line[summary[0].indexOf('film_hash')]);
    const text = await table.innerText();
    t.none(
      hashes.filter((hash) => !text.includes(hash)),
      'film hashes that the page does not show',
    );

    await screen.showPanel('Parameters');
    await screen.settled();
    t.check(await screen.page.evaluate(() => window.lab.picture.final), 'afterwards the image is rendered again');
  },

  'a change during a measurement is rendered afterwards': async (t) => {
    const { lab, screen, study } = await chosen(t);
    screen.context.setDefaultTimeout(60000);
    await study.getByRole('button', { name: 'Start', exact: true }).click();
    await running(screen, true);
    const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.6 } });
    t.more(generation, (await lab.get('/api/state')).picture.generation, 'rendering is suspended');
    await study.getByRole('button', { name: 'Stop', exact: true }).click();
    await running(screen, false);
    await screen.showPanel('Parameters');
    await screen.settled(generation);
    const film = JSON.parse(await lab.run('render', 'scenes/rod.yaml', '--set', 'liquid.ior=1.6', '--json')).film_hash;
    t.equal(await screen.page.evaluate(() => window.lab.picture.film_hash), film, 'the film of the change');
  },

  'the machine': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Machine');
    const panel = screen.page.getByRole('tabpanel', { name: 'Machine' });
    await panel.getByText('Kernel').waitFor();
    const text = await panel.innerText();
    const told = JSON.parse(await lab.run('machine', '--json'));
    for (const word of [...told.kernel.slice(0, 1), told.version])
      t.check(text.includes(word), `the panel does not show ${word}`);
  },
};
