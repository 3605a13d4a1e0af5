// The laboratory of `make site` as a reader has it, with its engine: from a server of plain files, and as one file from
// the disk, without a network. Skipped where the site was not made (build/site next to the program).
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { openFile, withFolder } from './file_page.mjs';
import { serveSite } from './site_server.mjs';

const DRAWN_MS = 300000;
const program = process.argv[process.argv.indexOf('--program') + 1];
const site = join(dirname(program), 'site');
const oneFile = join(site, 'laboratory.html');

/** The final image of the page or frame: its film and the file that is open. */
async function drawn(page, undone) {
  await page.waitForFunction(
    (changed) => window.lab?.image?.final && Boolean(window.lab.state.undo) === changed,
    Boolean(undone),
    { timeout: DRAWN_MS },
  );
  return page.evaluate(async () => {
    const { image, file } = await window.lab.get('/api/state');
    return { film: image.film_hash, file, engine: window.lab.engine.kind };
  });
}

const filmOf = (...words) => JSON.parse(execFileSync(program, ['render', ...words, '--json'])).film_hash;

/** A page of the site in a browser of its own. */
async function withPage(t, address, act, init = () => {}) {
  const server = await serveSite(site);
  const context = await t.browser.newContext({ viewport: { width: 1366, height: 768 }, acceptDownloads: true });
  try {
    const page = await context.newPage();
    await page.addInitScript(init);
    const errors = [];
    page.on('console', (message) => {
      const icon = message.location().url.endsWith('favicon.ico'); /* of the documentation: it has none */
      if (message.type() === 'error' && !icon) errors.push(message.text());
    });
    page.on('pageerror', (error) => errors.push(error.message));
    page.on('request', (request) => {
      const url = request.url();
      if (!url.startsWith(server.origin) && !/^(blob|data):/.test(url)) errors.push(`request: ${url}`);
    });
    await page.goto(`${server.origin}/${address}`);
    await act(page);
    t.none(errors, `${address}: errors`);
  } finally {
    await context.close();
    await server.close();
  }
}

/** Saves the scene of a page, or of a frame in it, as an HTML file. */
async function savePage(page, where, file) {
  await where.getByRole('tab', { name: 'Build' }).click();
  await where.getByRole('tab', { name: 'Objects' }).click();
  await where.getByRole('button', { name: 'Share …' }).click();
  const [download] = await Promise.all([
    page.waitForEvent('download'),
    where.getByRole('button', { name: 'HTML file' }).click(),
  ]);
  await download.saveAs(file);
}

const all = {
  'the first page leads to a glass of water': (t) =>
    withPage(t, '', async (page) => {
      await page.getByRole('link', { name: 'Open the laboratory' }).click();
      const found = await drawn(page);
      t.equal(found.engine, 'browser', 'the engine');
      t.equal(found.file, 'scenes/rod.yaml', 'the scene');
      t.equal(found.film, filmOf('experiments/scenes/rod.yaml'), 'the film is that of the program');
    }),

  'a scene of the gallery opens, also with changed parameters': async (t) => {
    await withPage(t, 'laboratory/?scene=scenes/coin.yaml', async (page) => {
      t.equal((await drawn(page)).film, filmOf('experiments/scenes/coin.yaml'), 'coin');
    });
    const tea = readFileSync(join(site, 'gallery.html'), 'utf8').match(/laboratory\/#scene=[\w-]+/)[0];
    await withPage(t, tea, async (page) => {
      t.equal((await drawn(page, true)).film, filmOf(tea.slice(tea.indexOf('#'))), 'tea');
    });
  },

  'a browser without vectors loads the plain module': (t) =>
    withPage(
      t,
      'laboratory/',
      async (page) => {
        const loaded = [];
        page.on('request', (request) => loaded.push(request.url()));
        await page.reload();
        t.equal((await drawn(page)).film, filmOf('experiments/scenes/rod.yaml'), 'the film');
        const modules = loaded.filter((url) => url.endsWith('.wasm')).map((url) => url.split('/').at(-2));
        t.equal(modules, ['plain'], 'the module');
      },
      () => {
        WebAssembly.validate = () => false;
      },
    ),

  'a lesson opens': (t) =>
    withPage(t, 'lesson-coin.html', async (page) => {
      await page.getByRole('link', { name: 'Open in the laboratory' }).click();
      await page
        .getByRole('button', { name: 'Start this lesson again' })
        .or(page.getByText('Predict'))
        .first()
        .waitFor();
      t.match(await page.locator('.panel-lessons').innerText(), /A coin comes into sight/, 'the lesson');
    }),

  'one file works from the disk': async (t) => {
    const shown = await openFile(t, oneFile, false);
    const { page } = shown;
    const before = await drawn(page);
    t.equal(before.film, filmOf('experiments/scenes/rod.yaml'), 'the film is that of the program');
    await page.evaluate(() => window.lab.set({ 'liquid.ior': 1.5 }));
    const changed = filmOf('experiments/scenes/rod.yaml', '--set', 'liquid.ior=1.5');
    t.equal((await drawn(page, true)).film, changed, 'after a change');
    t.none(
      shown.asked.filter((url) => !/^(file|data|blob):/.test(url)),
      'requests',
    );
    t.none(shown.errors, 'console');
    await shown.close();
  },

  'a live page of the command has the laboratory, and one saved from it too': (t) =>
    withFolder(async (folder) => {
      const file = join(folder, 'coin.html');
      execFileSync(program, ['render', 'experiments/scenes/coin.yaml', '-o', file, '--live'], {
        env: { ...process.env, CUVETTE_LIVE: oneFile },
      });
      const film = filmOf('experiments/scenes/coin.yaml');
      const turn = async (shown) => {
        await shown.page.getByRole('button', { name: 'Turn it yourself' }).click();
        const frame = shown.page.frames()[1];
        t.equal((await drawn(frame, true)).film, film, 'the film in the frame');
        return frame;
      };
      const shown = await openFile(t, file, false);
      const frame = await turn(shown);
      await t.image(shown, 'live-page');
      const again = join(folder, 'again.html');
      await savePage(shown.page, frame, again);
      await shown.close();
      t.equal(filmOf(again), film, 'the saved page holds the scene');
      const second = await openFile(t, again, false);
      await turn(second);
      t.none(second.errors, 'console');
      await second.close();
    }),

  'a page saved on a server has the laboratory': (t) =>
    withFolder((folder) =>
      withPage(t, 'laboratory/', async (page) => {
        await drawn(page);
        const saved = join(folder, 'saved.html');
        await savePage(page, page, saved);
        const shown = await openFile(t, saved, false);
        await shown.page.getByRole('button', { name: 'Turn it yourself' }).click();
        const { film } = await drawn(shown.page.frames()[1], true);
        t.equal(film, filmOf('experiments/scenes/rod.yaml'), 'the film');
        await shown.close();
      }),
    ),
};

export const cases = existsSync(oneFile) ? all : {};
if (!existsSync(oneFile)) console.log('skip  site: make site has not made build/site');
