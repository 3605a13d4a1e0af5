// A page of `cuvette render -o FILE.html --live`: its button starts the laboratory that it holds, with its scene and
// without a network; its policy allows scripts, workers and WebAssembly of the page, and no request. The laboratory is
// a small document here; site.test.mjs opens the real one.
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { openFile, withFolder } from './file_page.mjs';

const rod = 'experiments/scenes/rod.yaml';
const LABORATORY = `<!doctype html><html lang="en"><head><title>Laboratory</title></head><body><main><h1>Laboratory</h1>
<script>
const { dataset } = document.body;
addEventListener('securitypolicyviolation', (event) => (dataset.refused = event.effectiveDirective));
const worker = new Worker(URL.createObjectURL(new Blob(['postMessage("runs")'])));
worker.onmessage = ({ data }) => (dataset.worker = data);
WebAssembly.compile(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0])).then(() => (dataset.module = 'compiled'));
fetch('https://example.org/').catch(() => 0);
</script></main></body></html>`;

async function page(folder, program) {
  writeFileSync(join(folder, 'laboratory.html'), LABORATORY);
  const file = join(folder, 'rod.html');
  execFileSync(program, ['render', rod, '-o', file, '--live'], {
    env: { ...process.env, CUVETTE_LIVE: join(folder, 'laboratory.html') },
  });
  return file;
}

/** The laboratory saves such a page too, if the program finds that file, the only one that it reads outside its folder.
 */
async function saved(t, folder) {
  const lab = await t.lab('scenes/rod.yaml');
  const get = async (query) => new TextDecoder().decode((await lab.ask('GET', `/api/page.html${query}`)).bytes);
  await lab.stop();
  await lab.serve('scenes/rod.yaml', [], { CUVETTE_LIVE: join(folder, 'laboratory.html') });
  return { live: await get(''), plain: await get('?live=0'), empty: await get('?live=empty') };
}

export const cases = {
  "pages of the program's laboratory": (t) =>
    withFolder(async (folder) => {
      const commands = readFileSync(await page(folder, t.program), 'utf8');
      const { live, plain, empty } = await saved(t, folder);
      const codeOf = (text) => text.match(/id="cuvette-live">([^<]*)</)?.[1];
      t.equal(codeOf(live), codeOf(commands), 'the same laboratory as in a page of the command');
      t.equal(codeOf(plain), undefined, 'without it on request');
      t.equal(codeOf(empty), '', 'an empty place on request');
    }),

  'the button starts the laboratory with the scene': (t) =>
    withFolder(async (folder) => {
      const file = await page(folder, t.program);
      const shown = await openFile(t, file, false);
      const button = shown.page.getByRole('button', { name: 'Turn it yourself' });
      t.equal(await shown.page.locator('.stage img').isVisible(), true, 'the image is there at once');
      t.equal(await shown.page.frames().length, 2, 'one frame');
      t.equal(await shown.page.frames()[1].evaluate(() => document.body.childNodes.length), 0, 'which is empty before');
      await t.axe(shown, 'live page');
      await button.click();
      const frame = shown.page.frameLocator('#turned iframe');
      const body = frame.locator('body[data-worker][data-module][data-refused]');
      await body.waitFor();
      const found = await body.evaluate(({ dataset }) => [dataset.worker, dataset.module, dataset.refused]);
      t.equal(found, ['runs', 'compiled', 'connect-src'], 'what runs, and what is refused');
      const code = readFileSync(file, 'utf8').match(/id="cuvette-scene">([\w-]+)</)[1];
      t.equal(await frame.locator('#cuvette-scene').textContent(), code, 'the scene of the page');
      t.none(
        shown.asked.filter((url) => !/^(file|data|blob):/.test(url)),
        'requests',
      );
      await t.axe(shown, 'live page with the laboratory');
      await shown.page.getByRole('button', { name: 'Back to the image' }).click();
      t.equal(await shown.page.locator('#turned').isVisible(), false, 'back to the image');
      await button.click();
      await body.waitFor();
      await shown.page.keyboard.press('Escape');
      t.equal(await shown.page.locator('#turned').isVisible(), false, 'Escape too');
      await shown.close();
    }),

  'an empty place has no button': (t) =>
    withFolder(async (folder) => {
      const file = await page(folder, t.program);
      writeFileSync(file, readFileSync(file, 'utf8').replace(/(id="cuvette-live">)[^<]*/, '$1'));
      const shown = await openFile(t, file, false);
      t.equal(await shown.page.locator('#turn').isVisible(), false, 'no button');
      t.none(shown.errors, 'console');
      await shown.close();
    }),
};
