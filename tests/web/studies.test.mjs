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
  await screen.page.getByRole('navigation', { name: 'Studies' }).getByRole('button', { name: /brief/ }).click();
  const study = screen.page.getByRole('article', { name: 'Study' });
  await study.getByRole('heading', { name: 'Time by recursion depth and index' }).waitFor();
  return { lab, screen, study };
}

async function openForm(screen) {
  if (!(await screen.page.getByRole('tabpanel', { name: 'Studies' }).isVisible())) await screen.showPanel('Studies');
  await screen.button('New study').click();
  const dialog = screen.page.getByRole('dialog', { name: 'New study' });
  await dialog.waitFor();
  return dialog;
}

/** The visible controls of a dialog that are narrower or lower than 44 px; a label counts with its control. */
const small = (dialog) =>
  dialog.evaluate((root) =>
    [...root.querySelectorAll('button, input, summary, [role=option]')]
      .filter((node) => node.checkVisibility({ visibilityProperty: true }))
      .map((node) => (node.closest('label') || node).getBoundingClientRect())
      .filter(({ width, height }) => width < 43.5 || height < 43.5)
      .map(({ width, height, x, y }) => `${width} x ${height} at ${x}, ${y}`),
  );

const rowsOf = async (lab) =>
  (await readFile(join(lab.folder, 'results/brief/rows.csv'), 'utf8')).trim().split('\n').slice(1);
/** The rows without warm-ups, which a resumed run repeats. */
const measured = (rows) => rows.filter((row) => row.split(',')[4] === '0');

export const cases = {
  'a study is started, stopped and resumed to its end': async (t) => {
    const { lab, screen, study } = await chosen(t);
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
    const report = await lab.get('/api/studies/brief');
    t.equal([report.cells_done, report.marked], [CELLS, 0], 'cells done, rows of another film');
    // One line per depth or index with four markers each, and one in the legend.
    t.equal(await plot.locator('.plot-series .plot-marker').count(), CELLS + 4, 'markers in the figure');
    await t.axe(screen, 'a study with rows');
    const complete = study.getByRole('button', { name: 'Complete', exact: true });
    t.check(await complete.isDisabled(), 'a complete study cannot be started again');
    t.equal(await study.getByRole('button', { name: 'Measure the missing rows' }).count(), 0, 'buttons that measure');
    t.match(await study.locator('.facts').first().innerText(), /results\/brief/, 'the results folder');
    t.equal(
      await study.locator('.notice.warning').count(),
      report.disturbed ? 1 : 0,
      `notices of ${report.disturbed} disturbed rows`,
    );

    const summary = (await lab.run('study', 'summary', 'studies/brief.study'))
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

    const at = summary[0].indexOf('wall_s_median');
    const longest = Math.max(...summary.slice(1).map((line) => Number(line[at])));
    const [unit, factor] = longest >= 1 ? ['s', 1] : ['ms', 1000];
    const head = table.getByRole('columnheader', { name: /^wall_s_median/ });
    t.equal(await head.innerText(), unit === 's' ? 'wall_s_median' : `wall_s_median / ${unit}`, 'unit of the times');
    const column = (await table.locator('thead th').allInnerTexts()).findIndex((name) => /^wall_s_median/.test(name));
    const cell = table.locator('tbody tr').first().locator('th, td').nth(column);
    const exact = factor * Number(summary[1][at]);
    t.near(Number(await cell.innerText()), exact, 1e-4 * exact, 'the first time of the summary');
    t.equal(await plot.getByText(`wall time per frame / ${unit}`).count(), 1, 'unit of the figure');
    const places = await plot.locator('.plot-series').evaluateAll((all) =>
      all.map((one) => ({
        bars: [...one.querySelectorAll('.plot-interval')].map((bar) => parseFloat(bar.getAttribute('d').slice(1)) + 4),
        points: [...one.querySelectorAll('.plot-marker')].map((mark) =>
          parseFloat(mark.getAttribute('transform').slice(10)),
        ),
      })),
    );
    const drawn = places.filter(({ bars }) => bars.length);
    t.more(drawn.length, 1, 'curves with intervals');
    const firsts = drawn.map(({ points }) => points[0]);
    t.equal(new Set(firsts).size, drawn.length, `curves are apart at one x: ${firsts}`);
    t.less(Math.max(...firsts) - Math.min(...firsts), 30, 'but not far');
    for (const { bars, points } of drawn)
      t.check(
        bars.every((bar) => points.some((point) => Math.abs(point - bar) < 0.02)),
        'intervals through markers',
      );

    await study.getByText('Raw rows', { exact: true }).click();
    for (const [label, name, bytes] of [
      ['rows as CSV', 'brief-rows.csv', await readFile(join(lab.folder, 'results/brief/rows.csv'), 'utf8')],
      ['summary as TSV', 'brief.tsv', await lab.run('study', 'summary', 'studies/brief.study')],
    ]) {
      const saved = screen.page.waitForEvent('download');
      await study.getByRole('button', { name: `Save ${label}` }).click();
      const file = await saved;
      t.equal(file.suggestedFilename(), name, `name of the saved ${label}`);
      t.check((await readFile(await file.path(), 'utf8')) === bytes, `the saved ${label} are the program's bytes`);
    }
    await t.image(screen, 'study-complete');

    const compare = study.getByRole('group').filter({ has: screen.page.getByText('Compare', { exact: true }) });
    for (const [what, a, b, sides] of [
      ['Two rows of the summary', '3', '12', ['cell=3', 'cell=12']],
      ['Values of render.depth', '2', '8', ['render.depth=2', 'render.depth=8']],
    ]) {
      await compare.getByLabel('Compare', { exact: true }).selectOption(what);
      await compare.getByLabel('A', { exact: true }).selectOption(a);
      await compare.getByLabel('B', { exact: true }).selectOption(b);
      const said = JSON.parse(await lab.run('study', 'compare', 'studies/brief.study', ...sides, '--json'));
      const reply = await lab.get(`/api/studies/brief/compare?a=${sides[0]}&b=${sides[1]}`);
      t.equal(reply, said, `the comparison of ${sides} is that of the program`);
      const words = compare.getByText(/^.*B takes .* times as long as A/);
      await words.waitFor();
      const ratio = Number((await words.innerText()).match(/B takes ([\d.]+) times/)[1]);
      t.near(ratio, said.all.ratio, 0.01 * said.all.ratio, `ratio of ${sides}`);
      t.match(await words.innerText(), new RegExp(`Verdict: ${said.all.verdict}`), `verdict of ${sides}`);
      t.equal(await compare.locator('tbody tr').last().isVisible(), true, `a table of ${sides}`);
      await words.scrollIntoViewIfNeeded();
      await t.axe(screen, what);
      await t.image(screen, `study-compare-${a}`);
    }
    const outside = await lab.ask('GET', '/api/studies/brief/compare?a=/etc,cell=0&b=cell=1');
    t.equal(outside.status, 400, 'a side in another folder');

    for (const [format, start] of [
      ['SVG', '<?xml'],
      ['PNG', '\x89PNG'],
    ]) {
      const saved = screen.page.waitForEvent('download');
      await study.getByRole('button', { name: `Save figure as ${format}` }).click();
      const file = await saved;
      t.equal(file.suggestedFilename(), `brief.${format.toLowerCase()}`, 'name of the saved figure');
      const bytes = await readFile(await file.path(), 'latin1');
      t.equal(bytes.slice(0, start.length), start, `the saved figure is ${format}`);
    }

    await screen.showPanel('Parameters');
    await screen.settled();
    t.check(await screen.page.evaluate(() => window.lab.image.final), 'the image is rendered after the study');
  },

  'a change during a study is rendered afterwards': async (t) => {
    const { lab, screen, study } = await chosen(t);
    await study.getByRole('button', { name: 'Start', exact: true }).click();
    await running(screen, true);
    const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.6 } });
    t.more(
      generation,
      (await lab.get('/api/state')).image.generation,
      'the generation of the change is newer than that of the image',
    );
    await study.getByRole('button', { name: 'Stop', exact: true }).click();
    await running(screen, false);
    await screen.showPanel('Parameters');
    await screen.settled(generation);
    const film = JSON.parse(await lab.run('render', 'scenes/rod.yaml', '--set', 'liquid.ior=1.6', '--json')).film_hash;
    t.equal(await screen.page.evaluate(() => window.lab.image.film_hash), film, 'the film of the changed scene');
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
      [{ axes: [] }, 400, undefined, 'the number of axes is out of range'],
      [{ repetitions: 0.5 }, 400, 'repetitions', 'invalid number of repetitions'],
      [{ file: '../form.study' }, 400, 'file', 'not a valid study name'],
      [{ axes: ['background.image=/etc/passwd'] }, 400, undefined, 'outside of the folder'],
      [{ warmups: -1 }, 400, 'warmups', 'invalid number of warmups'],
      [{ save: true }, 409, 'file', 'already exists'],
    ]) {
      const reply = await lab.ask('POST', '/api/studies', { ...form, ...change });
      const { error, remedy, file } = JSON.parse(new TextDecoder().decode(reply.bytes));
      t.equal([reply.status, file], [status, field], `status and field of ${JSON.stringify(change)}`);
      t.check(error.includes(words) && remedy, `an error with a remedy: ${error}; ${remedy}`);
    }
    await lab.post('/api/objects', { kind: 'light' });
    t.equal((await lab.ask('POST', '/api/studies', form)).status, 409, 'a scene with other objects than its file');
  },

  'the form New study: estimate, errors at their fields, save and start': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await lab.post('/api/set', { set: { 'render.width': 80, 'render.height': 60 } });
    const screen = await t.open(lab, { width: 1366, height: 900 });
    screen.expect(/status of 4(00|09)/);
    const dialog = await openForm(screen);
    const button = (name) => dialog.getByRole('button', { name, exact: true });
    const axis = (number) => dialog.getByRole('group', { name: `Axis ${number}` });
    const alert = (of) => of.getByRole('alert');
    await button('Save').click();
    t.match(await alert(axis(1)).innerText(), /Choose a parameter/, 'an axis without a parameter');

    // The list of parameters is searched by everyday words, and by keys alone.
    await axis(1).getByRole('combobox', { name: 'Parameter' }).fill('bounces');
    t.equal(await axis(1).getByRole('option').first().locator('code').innerText(), 'render.depth', 'parameter found');
    await screen.page.keyboard.press('ArrowDown');
    await screen.page.keyboard.press('Enter');
    await axis(1).getByRole('textbox', { name: 'Values' }).fill('1, x');
    await button('Add an axis').click();
    await axis(2).getByRole('combobox', { name: 'Parameter' }).fill('liquid ior');
    await axis(2).getByRole('option').first().click();
    await axis(2).getByText('Range', { exact: true }).click();
    await axis(2).getByLabel('From').fill('1,1');
    await axis(2).getByLabel('To').fill('1.7');
    await axis(2).getByLabel('Count').fill('3');
    await dialog.getByLabel('File', { exact: true }).fill('sub form');
    await dialog.getByLabel('Repetitions').fill('2');
    await dialog.getByLabel('Warm-ups').fill('0');
    await button('Estimate').click();
    await alert(axis(1)).waitFor();
    t.match(await alert(axis(1)).innerText(), /'x' is not an integer/, 'the error of an axis is at its field');
    t.equal(await alert(axis(2)).count(), 0, 'errors at the other axis');
    t.equal(
      await axis(1)
        .getByLabel('Values')
        .evaluate((node) => node === document.activeElement),
      true,
      'the field with the error has the focus',
    );
    await t.axe(screen, 'the form with an error');

    await axis(1).getByLabel('Values').fill('1; 2');
    await button('Estimate').click();
    const facts = dialog.locator('.study-estimate .facts');
    await facts.waitFor();
    t.match(await facts.innerText(), /Cells\s+6\s+Rows\s+12\s+Time\s+.*\d+ (ms|s)/, 'the estimate');
    await t.axe(screen, 'the form with an estimate');
    t.equal((await lab.get('/api/files')).studies, ['studies/brief.study'], 'an estimate writes nothing');

    await dialog.getByLabel('File', { exact: true }).fill('studies/brief');
    t.equal(await facts.count(), 0, 'a changed form has no estimate');
    await button('Save').click();
    await alert(dialog.locator('.form-part').first()).waitFor();
    t.match(await alert(dialog).first().innerText(), /already exists/, 'the error of the file is at its field');
    t.check(await dialog.getByText('Replace the existing file').isVisible(), 'the form offers to replace the file');
    await screen.page.keyboard.press('Escape');
    await openForm(screen);
    t.equal(await axis(2).getByLabel('From').inputValue(), '1,1', 'a closed form keeps its values');

    await dialog.getByLabel('File', { exact: true }).fill('form');
    await button('Save and start').click();
    await dialog.waitFor({ state: 'detached' });
    const study = screen.page.getByRole('article', { name: 'Study' });
    await study.getByRole('heading', { name: 'Time and rays by render.depth, liquid.ior' }).waitFor();
    await screen.until(() => window.lab.study?.name === 'form' && !window.lab.study.running);
    await screen.page.getByRole('button', { name: /^form complete/ }).waitFor();
    const { rows, columns } = await lab.get('/api/studies/form/rows');
    const of = (name) => [...new Set(rows.map((row) => row[columns.indexOf(name)]))].sort();
    t.equal([rows.length, of('render.depth'), of('liquid.ior')], [12, ['1', '2'], ['1.1', '1.4', '1.7']], 'rows');
    const text = await readFile(join(lab.folder, 'form.study'), 'utf8');
    t.check(/render.width: 80/.test(text) && /warmups: 0/.test(text), 'unsaved changes and warm-ups are in the file');
    t.equal(
      await study.getByRole('region', { name: 'Summary' }).getByRole('table').locator('tbody tr').count(),
      6,
      'lines of the summary in the page',
    );
  },

  'the form on a telephone, and dark': async (t) => {
    for (const [name, options] of [
      ['phone', { width: 390, height: 844, touch: true }],
      ['dark', { width: 1366, height: 900, dark: true }],
      ['light', { width: 1366, height: 900 }],
    ]) {
      const screen = await t.open(await t.lab('scenes/rod.yaml'), options);
      const dialog = await openForm(screen);
      await dialog.getByRole('combobox', { name: 'Parameter' }).fill('depth');
      await t.axe(screen, `${name}: the list of parameters`);
      await t.image(screen, `study-form-found-${name}`);
      if (options.touch) t.none(await small(dialog), 'targets below 44 px in the list');
      await dialog.getByRole('option').first().click();
      await dialog.getByLabel('Values').fill('1, 2, 4');
      await dialog.getByText('Range', { exact: true }).click();
      await dialog.getByText('List', { exact: true }).click();
      await dialog.getByRole('button', { name: 'Estimate' }).click();
      await dialog.locator('.study-estimate .facts').waitFor();
      await t.axe(screen, `${name}: the estimate`);
      await t.image(screen, `study-form-${name}`);
      if (options.touch) t.none(await small(dialog), 'targets below 44 px');
      const over = await dialog.evaluate((node) => node.scrollWidth - node.clientWidth);
      t.check(over <= 0, `${name}: the dialog is ${over} pixels too narrow`);
    }
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
