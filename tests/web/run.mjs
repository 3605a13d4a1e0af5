// tests/web/run.mjs --program CUVETTE --modules FOLDER [--screenshots FOLDER] [--engine browser --wasm FOLDER]
// [NAME...]: runs tests/web/NAME.test.mjs, or all, in Chromium; prints one line per file and per failed check, and ends
// with "N passed, M failed". A file exports cases: {name: async (t) => ..}, and engine, if they are of one only; t has
// the checks of checks.mjs, t.lab(scene), t.open(lab, options) and t.axe(screen, what); pages and programs are closed
// at the end of the case. --engine browser: the page with the laboratory of `make wasm` in the browser instead of the
// program; the cases of needs_program.mjs are skipped.
import { execFileSync } from 'node:child_process';
import { readdirSync } from 'node:fs';
import { mkdir, readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { dirname, join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { BrowserLab } from './browser_lab.mjs';
import { Checks } from './checks.mjs';
import { Lab } from './lab.mjs';
import { needsProgram } from './needs_program.mjs';
import { Screen } from './screen.mjs';
import { siteOf } from './site.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const CASE_LIMIT_MS = 1800000; // a busy machine does not reach it
const { values: options, positionals: names } = parseArgs({
  options: {
    program: { type: 'string' },
    modules: { type: 'string' },
    screenshots: { type: 'string' },
    engine: { type: 'string', default: 'server' },
    wasm: { type: 'string' },
  },
  allowPositionals: true,
});

const inBrowser = options.engine === 'browser';

// The modules are installed in the build folder, where import does not search.
const installed = createRequire(join(options.modules, 'package.json'));
const { chromium } = installed('playwright-core');
const axePath = installed.resolve('axe-core/axe.min.js');

class Case extends Checks {
  labs = [];
  screens = [];
  program = options.program;
  screenshots = options.screenshots;
  engine = options.engine;

  async lab(scene) {
    const lab = inBrowser
      ? await BrowserLab.start(options.program, scene, siteOf(options.wasm), (each) => this.open(each))
      : await Lab.start(options.program, scene);
    this.labs.push(lab);
    return lab;
  }

  async open(lab, how) {
    const spare = await lab.takeSpare(how);
    const screen = spare ?? (await Screen.open(this.browser, lab, how));
    if (!spare) this.screens.push(screen);
    return screen;
  }

  /** Checks accessibility as far as a program can: one check per state of the page. */
  async axe(screen, what) {
    // Not as a script element: the page's Content-Security-Policy forbids those.
    await screen.page.evaluate(await axeSource());
    const { violations } = await screen.page.evaluate(() => window.axe.run(document, { resultTypes: ['violations'] }));
    this.none(
      violations.map(
        (v) =>
          `${v.id} (${v.impact}): ${v.nodes
            .map((n) => `${n.target.join(' ')} ${n.any[0]?.message ?? ''}`)
            .slice(0, 3)
            .join(', ')}`,
      ),
      `${what}: axe`,
    );
  }

  /** With --screenshots, saves an image of the whole page. */
  async image(screen, name) {
    if (!options.screenshots) return;
    await mkdir(options.screenshots, { recursive: true });
    await screen.page.screenshot({ path: join(options.screenshots, `${name}.png`) });
  }

  async end() {
    for (const screen of this.screens) {
      this.none(screen.unexpected, 'errors in the console and requests to other servers');
      await screen.close().catch(() => {});
    }
    for (const lab of this.labs) await lab.end();
  }
}

let axe = null;
const axeSource = () => (axe ??= readFile(axePath, 'utf8'));

function limited(promise) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error(`not done within ${CASE_LIMIT_MS / 1000} s`)), CASE_LIMIT_MS);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

async function runCase(browser, body) {
  const t = new Case();
  t.browser = browser;
  try {
    await limited(body(t));
    t.check(t.passed + t.failures.length > 0, 'a case without a check');
  } catch (error) {
    t.failures.push(`${error.message}`.split('\n').slice(0, 4).join(' ') + at(error));
  }
  await t.end().catch((error) => t.failures.push(`at the end: ${error.message}`));
  return t;
}

/** The line of a test file where an error occurred. */
function at(error) {
  const line = `${error.stack}`.match(/[\w.-]+\.test\.mjs:\d+/);
  return line ? ` (${line[0]})` : '';
}

const selected = readdirSync(here)
  .filter((file) => file.endsWith('.test.mjs'))
  .map((file) => file.replace('.test.mjs', ''))
  .sort()
  .filter((name) => names.length === 0 || names.includes(name));
const browser = await chromium.launch({
  executablePath:
    process.env.CHROMIUM ?? execFileSync('sh', ['-c', 'command -v chromium'], { encoding: 'utf8' }).trim(),
  headless: true,
  args: ['--force-color-profile=srgb', ...(process.getuid() === 0 ? ['--no-sandbox'] : [])],
});
let [passed, failed] = [0, 0];
const skipped = [];
for (const name of selected) {
  const { cases, engine = options.engine } = await import(pathToFileURL(join(here, `${name}.test.mjs`)));
  if (engine !== options.engine) continue;
  const lines = [];
  let good = 0;
  for (const [what, body] of Object.entries(cases)) {
    const reason = inBrowser && needsProgram(name, what);
    if (reason) {
      skipped.push(`skip  ${name}: ${what}: ${reason}`);
      continue;
    }
    const t = await runCase(browser, body);
    good += t.passed;
    lines.push(...t.failures.map((line) => `      ${what}: ${line}`));
  }
  if (!good && !lines.length) continue;
  console.log(
    lines.length
      ? `FAIL  ${name.padEnd(24)} ${lines.length} of ${good + lines.length}`
      : `pass  ${name.padEnd(24)} ${good}`,
  );
  for (const line of lines) console.log(line);
  passed += good;
  failed += lines.length;
}
await browser.close();
for (const line of skipped) console.log(line);
console.log(`${passed} passed, ${failed} failed${skipped.length ? `, ${skipped.length} cases skipped` : ''}`);
process.exitCode = failed === 0 && passed > 0 ? 0 : 1;
