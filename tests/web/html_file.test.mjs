// The self-contained HTML file of `cuvette render -o FILE.html`: opened from the disk without a network it shows the
// image and the rays with the numbers of `cuvette trace`, requests nothing, and runs no script.
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { openFile, withFolder } from './file_page.mjs';

const rod = 'experiments/scenes/rod.yaml';

async function look(t, shown, name) {
  const { page, asked, errors } = shown;
  t.equal(await page.evaluate(() => document.querySelector('.stage img').naturalWidth), 800, `${name}: the image`);
  t.equal(await page.evaluate(() => document.scripts.length), 1, `${name}: no element but the scene's is a script`);
  t.none(
    asked.filter((url) => !url.startsWith('file:') && !url.startsWith('data:')),
    `${name}: requests`,
  );
  t.none(errors, `${name}: console`);
  await t.axe(shown, name);
  await t.image(shown, `html-file-${name}`);
}

export const cases = {
  'the rays of a pixel': (t) =>
    withFolder(async (folder) => {
      const file = join(folder, 'rod.html');
      execFileSync(t.program, ['render', rod, '-o', file]);
      const tree = JSON.parse(execFileSync(t.program, ['trace', rod, '--pixel', '400,300', '--json']));
      for (const dark of [false, true]) {
        const shown = await openFile(t, file, dark);
        await look(t, shown, dark ? 'dark' : 'light');
        const { page } = shown;
        const row = await page.locator('#r1 td').allInnerTexts();
        const { hit } = tree.root;
        t.equal(Number(row[9]), Number(hit.R.toPrecision(6)), 'R of the first row is that of the trace');
        t.equal(Number(row[4]), Number(hit.from.n.toPrecision(6)), 'n1');
        t.equal(Number(row[7].replace('°', '')), Number(((Math.acos(hit.cos_i) * 180) / Math.PI).toFixed(4)), 'angle');
        const numbers = page.locator('#s2 .numbers');
        const visible = () => numbers.evaluate((node) => getComputedStyle(node).visibility);
        t.equal(await visible(), 'hidden', 'numbers before');
        await page.locator('#s2').focus();
        t.equal(await visible(), 'visible', 'numbers of the line with the focus');
        await page.locator('#s1').focus();
        t.equal(await visible(), 'hidden', 'numbers of a line without focus');
        await page.locator('#r2 a').click();
        t.equal(await visible(), 'visible', 'numbers of the line that a row leads to');
        await page.locator('#s4').press('Enter');
        t.equal(await page.evaluate(() => location.hash), '#r4', 'a line leads to its row');
        await shown.close();
      }
    }),

  'the rays of beams': (t) =>
    withFolder(async (folder) => {
      const scene = join(folder, 'beam.yaml');
      const file = join(folder, 'beam.html');
      execFileSync(t.program, ['scene', rod, '--add', 'beam:laser', '-o', scene]);
      execFileSync(t.program, ['render', scene, '-o', file]);
      const { beams } = JSON.parse(execFileSync(t.program, ['trace', scene, '--beams', '--json']));
      const shown = await openFile(t, file, false);
      await look(t, shown, 'beams');
      const row = await shown.page.locator('#r1 td').allInnerTexts();
      t.equal(row[0].startsWith('laser 1, '), true, 'the beam and its ray');
      const root = beams[0].rays[0].root;
      t.equal(Number(row[9]), root.hit ? Number(root.hit.R.toPrecision(6)) : 0, 'R is that of the trace');
      t.equal(readFileSync(file, 'utf8').includes('Rays of the beams'), true, 'the heading');
      await shown.close();
    }),
};
