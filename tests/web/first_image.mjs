// tests/web/first_image.mjs --site FOLDER --modules FOLDER [--rounds N] [--scene NAME]: the laboratory of `make site`
// from a local server, opened N times by a browser without a cache: milliseconds from the start of the navigation to
// the first drawn image and to the final one, as median and worst; then each file that was loaded before the first
// image, with its bytes, plain and compressed; and the same times of the laboratory in one file, opened from the disk.
// Not a test: times depend on the machine.
import { execFileSync } from 'node:child_process';
import { createRequire } from 'node:module';
import { readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';
import { serveSite } from './site_server.mjs';

const { values: options } = parseArgs({
  options: {
    site: { type: 'string' },
    modules: { type: 'string' },
    rounds: { type: 'string', default: '7' },
    scene: { type: 'string', default: 'scenes/rod.yaml' },
  },
});
const { chromium } = createRequire(resolve(options.modules, 'package.json'))('playwright-core');

const median = (times) => [...times].sort((a, b) => a - b)[times.length >> 1];
const summary = (times) => `${median(times).toFixed(0)} (worst ${Math.max(...times).toFixed(0)})`;

/** In the page: notes when an image is drawn for the first time, and when the final one is. */
function watch() {
  window.times = {};
  const look = () => {
    const picture = window.lab?.picture;
    if (picture) window.times.first ??= performance.now();
    if (picture?.final) window.times.final ??= performance.now();
    if (!window.times.final) requestAnimationFrame(look);
  };
  requestAnimationFrame(look);
}

async function openOnce(browser, address, sent) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 768 } });
  const page = await context.newPage();
  await page.addInitScript(watch);
  await page.goto(address);
  await page.waitForFunction(() => window.times.first);
  const loaded = [...sent];
  await page.waitForFunction(() => window.times.final, null, { timeout: 120000 });
  const times = await page.evaluate(() => window.times);
  await context.close();
  return { ...times, loaded };
}

async function measure(browser, what, address, sent = new Set()) {
  const rounds = [];
  for (let i = 0; i < Number(options.rounds); i++) {
    sent.clear();
    rounds.push(await openOnce(browser, address, sent));
  }
  const of = (name) => summary(rounds.map((round) => round[name]));
  console.log(`${what}: first image ${of('first')} ms, final image ${of('final')} ms`);
  return rounds.at(-1).loaded;
}

function reportBytes(paths) {
  const total = [0, 0];
  for (const path of paths) {
    const content = readFileSync(join(options.site, path));
    const sizes = [content.length, gzipSync(content, { level: 9 }).length];
    sizes.forEach((size, at) => (total[at] += size));
    console.log(`  ${path.padEnd(44)} ${sizes.map((size) => String(size).padStart(10)).join('')}`);
  }
  console.log(`  ${'bytes, compressed'.padEnd(44)} ${total.map((size) => String(size).padStart(10)).join('')}`);
}

const browser = await chromium.launch({
  executablePath:
    process.env.CHROMIUM ?? execFileSync('sh', ['-c', 'command -v chromium'], { encoding: 'utf8' }).trim(),
  args: process.getuid() === 0 ? ['--no-sandbox'] : [],
});
const sent = new Set();
const server = await serveSite(options.site, {}, (path) => sent.add(path));
const query = `?scene=${encodeURIComponent(options.scene)}`;
const loaded = await measure(browser, 'from a server', `${server.origin}/laboratory/${query}`, sent);
reportBytes(loaded);
await measure(browser, 'one file', `${pathToFileURL(resolve(options.site, 'laboratory.html')).href}${query}`);
await server.close();
await browser.close();
