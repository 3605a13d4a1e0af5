// Studies on the page: one is started, stopped half way and resumed to its end, and its table equals the output of the
// program.
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
/** The rows without warm-ups, which a resumed run repeats. */
const measured = (rows) => rows.filter((row) => row.split(',')[4] === '0');

export const cases = {
  'a study is started, stopped and resumed to its end': async (t) => {
    const { lab, screen, study } = await chosen(t);
    screen.context.setDefaultTimeout(60000);
    await study.getByRole('button', { name: 'Start', exact: true }).click();
    await running(screen, true);
    await screen.until(() => window.lab.study.frames_done > 12);
    t.check((await lab.get('/api/state')).waiting, 'the state reports that rendering waits for the study');
    await study.getByRole('progressbar').waitFor();
    await study.getByRole('button', { name: 'Stop', exact: true }).click();
    await running(screen, false);
    await screen.quiet();
    const some = await rowsOf(lab);
    t.more(some.length, 12, 'rows after the stop');
    t.check(measured(some).length < ROWS, `stopped after ${measured(some).length} of ${ROWS} rows, not before the end`);
    const plot = study.getByRole('img', { name: /Time by recursion depth and index/ });
    t.more(await plot.locator('.plot-marker').count(), 0, 'markers in the figure');

    await study.getByRole('button', { name: 'Continue' }).click();
    await running(screen, true);
    await running(screen, false);
    await screen.until(() => window.lab.study.frames_done === window.lab.study.frames_all);
    await screen.quiet();
    const all = await rowsOf(lab);
    t.equal(measured(all).length, ROWS, 'rows at the end');
    t.equal(all.slice(0, some.length), some, 'the rows of the first run are unchanged');
    const report = await lab.get('/api/studies/quick');
    t.equal([report.cells_done, report.marked], [CELLS, 0], 'cells done, rows of another film');
    // One line per depth or index with four markers each, and one in the legend.
    t.equal(await plot.locator('.plot-series .plot-marker').count(), CELLS + 4, 'markers in the figure');
    await t.axe(screen, 'a study with rows');

    const summary = (await lab.run('study', 'summary', 'studies/quick.study'))
      .trim()
      .split('\n')
      .map((line) => line.split('\t'));
    t.equal(report.summary.columns, summary[0], 'columns of the summary');
    t.equal(report.summary.rows.length, summary.length - 1, 'lines of the summary');
    const table = study.getByRole('region', { name: 'Summary' }).getByRole('table');
    t.equal(await table.locator('tbody tr').count(), CELLS, 'lines of the summary in the page');
    const hashes = summary.slice(1).map((line) => line[summary[0].indexOf('film_hash')]);
    const text = await table.innerText();
    t.none(
      hashes.filter((hash) => !text.includes(hash)),
      'film hashes that the page does not show',
    );

    for (const [format, start] of [
      ['SVG', '<?xml'],
      ['PNG', '\x89PNG'],
    ]) {
      const saved = screen.page.waitForEvent('download');
      await study.getByRole('button', { name: `Save figure as ${format}` }).click();
      const file = await saved;
      t.equal(file.suggestedFilename(), `quick.${format.toLowerCase()}`, 'name of the saved figure');
      const bytes = await readFile(await file.path(), 'latin1');
      t.equal(bytes.slice(0, start.length), start, `the saved figure is ${format}`);
    }

    await screen.showPanel('Parameters');
    await screen.settled();
    t.check(await screen.page.evaluate(() => window.lab.picture.final), 'the image is rendered after the study');
  },

  'a change during a study is rendered afterwards': async (t) => {
    const { lab, screen, study } = await chosen(t);
    screen.context.setDefaultTimeout(60000);
    await study.getByRole('button', { name: 'Start', exact: true }).click();
    await running(screen, true);
    const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.6 } });
    t.more(
      generation,
      (await lab.get('/api/state')).picture.generation,
      'the generation of the change is newer than that of the image',
    );
    await study.getByRole('button', { name: 'Stop', exact: true }).click();
    await running(screen, false);
    await screen.showPanel('Parameters');
    await screen.settled(generation);
    const film = JSON.parse(await lab.run('render', 'scenes/rod.yaml', '--set', 'liquid.ior=1.6', '--json')).film_hash;
    t.equal(await screen.page.evaluate(() => window.lab.picture.film_hash), film, 'the film of the changed scene');
  },

  'a new study is estimated, saved and accepted by the program': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await lab.post('/api/set', { set: { 'liquid.ior': 1.5, 'render.width': 120 } });
    const form = { file: 'form.study', axes: ['render.depth=1,2,4', 'rod.visible=on,off'], repetitions: 7 };
    const estimate = await lab.post('/api/studies', form);
    t.equal([estimate.name, estimate.cells, estimate.rows], ['form', 6, 42], 'name, cells and rows');
    t.more(estimate.most_s, 0, 'estimated time');
    const files = async () => (await lab.get('/api/files')).studies;
    t.check(!(await files()).includes('form.study'), 'an estimate writes nothing');
    const saved = await lab.post('/api/studies', { ...form, save: true });
    t.equal(saved, { name: 'form', file: 'form.study', cells: 6 }, 'the saved study');
    t.equal(await readFile(join(lab.folder, 'form.study'), 'utf8'), estimate.text, 'the file is the text shown before');
    t.check(estimate.text.includes('liquid.ior: 1.5'), 'a change since the scene was opened is set in all cells');
    const said = await lab.run('study', 'run', '--dry-run', 'form.study');
    t.equal(estimate.said.split('\n')[0], said.split('\n')[0], 'rows to measure, as the program counts them');

    for (const [change, status, field, words] of [
      [{ axes: ['render.depth=1,x'] }, 400, '--axis render.depth=1,x', "'x' is not an integer"],
      [{ axes: [] }, 400, undefined, 'a study has 1 to 16 axes'],
      [{ repetitions: 0.5 }, 400, 'repetitions', 'invalid number of repetitions'],
      [{ file: '../form.study' }, 400, 'file', 'not a valid study name'],
      [{ axes: ['background.picture=/etc/passwd'] }, 400, undefined, 'outside of the folder'],
      [{ save: true }, 409, undefined, 'already exists'],
    ]) {
      const reply = await lab.ask('POST', '/api/studies', { ...form, ...change });
      const { error, remedy, file } = JSON.parse(new TextDecoder().decode(reply.bytes));
      t.equal([reply.status, file], [status, field], `status and field of ${JSON.stringify(change)}`);
      t.check(error.includes(words) && remedy, `an error with a remedy: ${error}; ${remedy}`);
    }
    await lab.post('/api/objects', { kind: 'light' });
    t.equal((await lab.ask('POST', '/api/studies', form)).status, 409, 'a scene with other objects than its file');
  },

  'the panel Machine has the kernel and version of cuvette machine': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Machine');
    const panel = screen.page.getByRole('tabpanel', { name: 'Machine' });
    await panel.getByText('Kernel').waitFor();
    const text = await panel.innerText();
    const machine = JSON.parse(await lab.run('machine', '--json'));
    for (const word of [...machine.kernel.slice(0, 1), machine.version])
      t.check(text.includes(word), `the panel does not show ${word}`);
  },
};
