// tests/web/bench.mjs --program CUVETTE --modules FOLDER [--changes N]: how soon the page shows what was asked for, in
// milliseconds: the start of the
// program to the first picture drawn, and a change of an index to its first and to its final picture drawn, by medians
// and worst of N. No test: times
// depend on the machine.
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { Lab } from './lab.mjs';
import { Screen } from './screen.mjs';

const { values: options } = parseArgs({
  options: { program: { type: 'string' }, modules: { type: 'string' }, changes: { type: 'string', default: '40' } },
});
const { chromium } = createRequire(resolve(options.modules, 'package.json'))('playwright-core');

const median = (times) => [...times].sort((a, b) => a - b)[times.length >> 1];
const told = (times) => `${median(times).toFixed(0)} (worst ${Math.max(...times).toFixed(0)})`;

/** Changes the index, and waits until the page has drawn the first and the final picture of that generation or a newer
 * one. */
const change = (screen, ior) =>
  screen.page.evaluate(async (value) => {
    const { lab } = window;
    const began = performance.now();
    let first = null;
    const done = new Promise((resolve) => {
      const end = lab.on('picture', () => {
        if (!lab.picture || lab.picture.generation <= before) return;
        first ??= performance.now() - began;
        if (!lab.picture.final) return;
        end();
        resolve();
      });
    });
    const before = lab.newestGeneration;
    lab.set({ 'liquid.ior': value });
    await done;
    return { first, final: performance.now() - began };
  }, ior);

async function measure(screen, what, settings) {
  if (Object.keys(settings).length) await screen.lab.post('/api/set', { set: settings });
  await screen.settled();
  const first = [],
    final = [];
  for (let i = 0; i < Number(options.changes); i++) {
    const times = await change(screen, 1.2 + 0.01 * i);
    first.push(times.first);
    final.push(times.final);
  }
  console.log(`${what}: first picture ${told(first)} ms, final picture ${told(final)} ms`);
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  args: process.getuid() === 0 ? ['--no-sandbox'] : [],
});
try {
  const starts = [];
  for (let i = 0; i < 5; i++) {
    const began = performance.now();
    const lab = await Lab.start(options.program, 'scenes/rod.yaml');
    const page = await browser.newPage();
    await page.goto(lab.address);
    await page.waitForFunction(() => window.lab?.picture, null, { polling: 10 });
    starts.push(performance.now() - began);
    await page.close();
    await lab.end();
  }
  console.log(`start of the program to the first picture: ${told(starts)} ms`);
  const lab = await Lab.start(options.program, 'scenes/rod.yaml');
  const screen = await Screen.open(browser, lab);
  await measure(screen, 'rod, 800x600, depth 4', {});
  await measure(screen, 'rod, 800x600, depth 8', { 'render.depth': 8 });
  await measure(screen, 'rod, 800x600, depth 8, 16 samples', { 'render.depth': 8, 'render.samples': 16 });
  await screen.close();
  await lab.end();
} finally {
  await browser.close();
}
