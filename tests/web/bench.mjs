// tests/web/bench.mjs --program CUVETTE --modules FOLDER [--changes N] [--drag SECONDS]: the latency of the page in
// milliseconds: from the start of the program to the first drawn image, and from a change of an index to its first and
// its final drawn image, as median and worst of N; images per second while the camera is dragged at 60 Hz (or a slime
// plays): the median over the seconds, the longest gap, drawn over fetched images, and their pixels; and, over a link
// of 1 Mbit/s and 100 ms, the time from a change to the first full-size image and to the final, exact one, with the
// bytes of a change. Not a test: times depend on the machine.
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { Lab } from './lab.mjs';
import { Screen } from './screen.mjs';
import { SlowLink } from './slow_link.mjs';

const { values: options } = parseArgs({
  options: {
    program: { type: 'string' },
    modules: { type: 'string' },
    changes: { type: 'string', default: '40' },
    drag: { type: 'string', default: '5' },
  },
});
const { chromium } = createRequire(resolve(options.modules, 'package.json'))('playwright-core');

const launch = (...more) =>
  chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: [...(process.getuid() === 0 ? ['--no-sandbox'] : []), ...more],
  });

const median = (times) => [...times].sort((a, b) => a - b)[times.length >> 1];
const summary = (times) => `${median(times).toFixed(0)} (worst ${Math.max(...times).toFixed(0)})`;

/** Changes the index; milliseconds until the page has drawn the first image of that generation or a newer one, the
 * first of full size, and the final one, which is exact. */
const change = (page, ior) =>
  page.evaluate(async (value) => {
    const { lab } = window;
    const began = performance.now();
    const width = lab.param('render.width').value;
    let first = null,
      full = null;
    const done = new Promise((resolve) => {
      const end = lab.on('image', () => {
        if (!lab.image || lab.image.generation <= before) return;
        const now = performance.now() - began;
        first ??= now;
        if (lab.image.width === width) full ??= now;
        if (!lab.image.final) return;
        end();
        resolve();
      });
    });
    const before = lab.newestGeneration;
    lab.set({ 'liquid.ior': value });
    await done;
    return { first, full, final: performance.now() - began };
  }, ior);

async function measure(screen, what, settings) {
  if (Object.keys(settings).length) await screen.lab.post('/api/set', { set: settings });
  await screen.settled();
  const first = [],
    final = [];
  for (let i = 0; i < Number(options.changes); i++) {
    const times = await change(screen.page, 1.2 + 0.01 * i);
    first.push(times.first);
    final.push(times.final);
  }
  console.log(`${what}: first image ${summary(first)} ms, final image ${summary(final)} ms`);
}

/** Drags the camera for the given time, a move every 1/60 s, unless the scene moves by itself. */
async function drag(screen, scene, moves) {
  const { page } = screen;
  let fetched = 0;
  const count = (request) => (fetched += new URL(request.url()).pathname.startsWith('/api/image.') ? 1 : 0);
  page.on('request', count);
  await page.evaluate(() => {
    window.times = [];
    window.pixels = [];
    let last = 0;
    window.lab.on('image', ({ serial, width, height }) => {
      if (serial !== last) {
        window.times.push(performance.now());
        window.pixels.push(width * height);
      }
      last = serial;
    });
  });
  const { x, y } = await screen.place(400, 300);
  await page.mouse.move(x, y);
  if (!moves) await page.mouse.down();
  const began = performance.now();
  const seconds = Number(options.drag);
  for (let i = 0; performance.now() - began < 1000 * seconds; i++) {
    if (!moves) await page.mouse.move(x + 100 * Math.sin(i / 30), y + 30 * Math.sin(i / 47));
    const next = began + ((i + 1) * 1000) / 60 - performance.now();
    if (next > 0) await new Promise((resolve) => setTimeout(resolve, next));
  }
  const { times, pixels } = await page.evaluate(() => ({ times: window.times, pixels: window.pixels }));
  if (!moves) await page.mouse.up();
  page.off('request', count);
  const each = Array.from({ length: seconds }, (_, s) => {
    const from = times[0] + 1000 * s;
    return times.filter((t) => t >= from && t < from + 1000).length;
  });
  const gaps = times.slice(1).map((t, i) => t - times[i]);
  console.log(
    `${scene}: ${median(each)} images/s (${Math.min(...each)} to ${Math.max(...each)}), longest gap ` +
      `${Math.max(...gaps).toFixed(0)} ms, drawn/fetched ${(times.length / fetched).toFixed(2)}, ` +
      `pixels ${median(pixels)} (median)`,
  );
}

async function slow(lab) {
  const link = await SlowLink.open(lab.port, { bitsPerS: 1e6, latencyMs: 100 });
  const browser = await launch(`--host-resolver-rules=MAP 127.0.0.1:${lab.port} 127.0.0.1:${link.port}`);
  const page = await browser.newPage();
  await page.goto(lab.address);
  await page.waitForFunction(() => window.lab?.image?.final, null, { polling: 50 });
  const loaded = link.down.bytes;
  const full = [],
    exact = [];
  for (let i = 0; i < Number(options.changes); i++) {
    const times = await change(page, 1.2 + 0.01 * i);
    full.push(times.full);
    exact.push(times.final);
  }
  const each = (direction, from = 0) => ((direction.bytes - from) / 1000 / full.length).toFixed(1);
  console.log(
    `rod, 1 Mbit/s, 100 ms: full-size image ${summary(full)} ms, exact image ${summary(exact)} ms, ` +
      `a change ${each(link.down, loaded)} kB down, start ${(loaded / 1000).toFixed(0)} kB`,
  );
  await browser.close();
  link.close();
}

const browser = await launch();
try {
  const starts = [];
  for (let i = 0; i < 5; i++) {
    const began = performance.now();
    const lab = await Lab.start(options.program, 'scenes/rod.yaml');
    const page = await browser.newPage();
    await page.goto(lab.address);
    await page.waitForFunction(() => window.lab?.image, null, { polling: 10 });
    starts.push(performance.now() - began);
    await page.close();
    await lab.end();
  }
  console.log(`start of the program to the first image: ${summary(starts)} ms`);
  const lab = await Lab.start(options.program, 'scenes/rod.yaml');
  const screen = await Screen.open(browser, lab);
  await measure(screen, 'rod, 800x600, depth 4', {});
  await measure(screen, 'rod, 800x600, depth 8', { 'render.depth': 8 });
  await measure(screen, 'rod, 800x600, depth 8, 16 samples', { 'render.depth': 8, 'render.samples': 16 });
  await screen.close();
  await lab.end();
  const far = await Lab.start(options.program, 'scenes/rod.yaml');
  await slow(far);
  await far.end();
  for (const scene of ['rod', 'models', 'rainbow', 'slime']) {
    const room = await Lab.start(options.program, `scenes/${scene}.yaml`);
    const view = await Screen.open(browser, room);
    if (scene === 'slime') await room.post('/api/slime', { do: 'play' });
    await drag(view, scene === 'slime' ? 'slime, playing' : scene, scene === 'slime');
    await view.close();
    await room.end();
  }
} finally {
  await browser.close();
}
