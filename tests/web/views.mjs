// tests/web/views.mjs --program CUVETTE --modules FOLDER --out FOLDER [--only VIEW]: screenshots of the laboratory for
// the documents (src/web/views). Not a test; run it from the project's root, whose scenes and studies it shows. The
// study on depth is measured first, half a minute on a quiet machine.
import { execFileSync } from 'node:child_process';
import { mkdir } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { Lab } from './lab.mjs';
import { Screen } from './screen.mjs';

const { values: options } = parseArgs({
  options: {
    program: { type: 'string' },
    modules: { type: 'string' },
    out: { type: 'string' },
    only: { type: 'string' },
  },
});
const { chromium } = createRequire(resolve(options.modules, 'package.json'))('playwright-core');
const size = { width: 1366, height: 768 };

const results = 'build/views'; /* a run that is complete is not measured again */

/** The laboratory in the project's own folder; nothing is saved there. */
async function serve(scene) {
  const lab = new Lab();
  lab.program = options.program;
  lab.folder = process.cwd();
  await lab.serve(scene, ['--results', join(lab.folder, results)]);
  return lab;
}

async function showBench(screen) {
  await screen.showPanel('Bench');
  const { lab } = screen;
  await lab.post('/api/objects', { kind: 'beam', name: 'sheet' });
  await lab.post('/api/objects', { kind: 'beam', name: 'laser' });
  const { generation } = await lab.post('/api/set', {
    set: {
      'sheet.kind': 'sheet',
      'sheet.rays': 7,
      'sheet.width': 0.9,
      'sheet.normal': [0, 1, 0],
      'sheet.position': [-2.6, 0.8, 0],
      'sheet.target': [0, 0.8, 0],
      'sheet.lambda_nm': 633,
      'sheet.branches': 'off',
      'laser.position': [-0.5, 0.6, -2.4],
      'laser.target': [-0.3, 1.7, -0.3],
      'laser.lambda_nm': 532,
    },
  });
  await lab.post('/api/camera', { orbit: [-25, 14] });
  await screen.settled(generation);
  await screen.page.getByRole('button', { name: 'laser', exact: true }).click();
  await screen.page
    .getByRole('button', { name: /^refracted: liquid/ })
    .first()
    .click();
  await screen.quiet();
}

/** A lesson with a prediction, scrolled to its curve. */
const predict = async (screen, title, guess) => {
  const { page } = screen;
  await screen.showPanel('Lessons');
  await page.getByRole('button', { name: title }).click();
  await page.locator('.lesson-prediction').getByRole('spinbutton').fill(guess);
  await screen.button('Compare', true).click();
  await page.locator('.lesson-value').waitFor();
  await screen.settled();
  await page.locator('.theory-chart figcaption').evaluate((node) => node.scrollIntoView({ block: 'end' }));
  await screen.quiet();
};

const views = {
  gallery: {
    scene: 'experiments/scenes/rod.yaml',
    async show(screen) {
      await screen.showPanel('Lessons');
      await screen.page.locator('.lesson-card').nth(7).waitFor();
      await screen.quiet();
    },
  },
  lesson: {
    scene: 'experiments/scenes/rod.yaml',
    show: (screen) => predict(screen, /^A glass of water is a lens/, '2.5'),
  },
  pixel: {
    scene: 'experiments/scenes/rod.yaml',
    async show(screen) {
      await screen.showPanel('Pixel');
      await screen.chooseTool('Inspect');
      await screen.clickPixel(330, 420);
      await screen.quiet();
    },
  },
  bench: {
    scene: 'experiments/scenes/rod.yaml',
    show: showBench,
  },
  studies: {
    scene: 'experiments/scenes/rod.yaml',
    async show(screen) {
      await screen.showPanel('Studies');
      await screen.page
        .getByRole('button', { name: /^depth\b/ })
        .first()
        .click();
      await screen.quiet();
    },
  },
  phone: {
    scene: 'experiments/scenes/rod.yaml',
    size: { width: 390, height: 844, touch: true },
    async show(screen) {
      await screen.showPanel('Parameters');
      await screen.setNumber('liquid.ior', '1,47');
      await (await screen.paramSlider('liquid.ior')).focus();
      await screen.button('Dismiss').click();
    },
  },
};

await mkdir(options.out, { recursive: true });
await mkdir(results, { recursive: true });
if (!options.only || options.only === 'studies')
  execFileSync(options.program, ['study', 'run', '--quiet', '--results', results, 'experiments/depth.study']);
const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: process.getuid() === 0 ? ['--no-sandbox'] : [],
});
try {
  for (const [name, view] of Object.entries(views).filter(([each]) => !options.only || each === options.only)) {
    const lab = await serve(view.scene);
    const screen = await Screen.open(browser, lab, { ...size, ...view.size });
    await view.show(screen);
    await screen.page.screenshot({ path: join(options.out, `${name}.jpg`), type: 'jpeg', quality: 88 });
    await screen.close();
    await lab.stop();
  }
} finally {
  await browser.close();
}
