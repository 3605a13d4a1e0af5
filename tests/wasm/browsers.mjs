// The films of all shipped scenes in real browsers: browsers.mjs --program build/cuvette --wasm build/wasm
// [--browser chromium] [--browser firefox-esr] [--size 160x120] [SCENE ..]. Each browser runs headless, by its own
// command line alone, on a page that renders every scene in the laboratory's worker, with and without SIMD, with one
// and with several tile workers, and sends back film hashes and ray counts; they have to equal those of the program.
import { execFileSync, spawn } from 'node:child_process';
import { createServer } from 'node:http';
import { mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, relative } from 'node:path';

const LIMIT_MS = 900000;
const RUNS = [
  { isa: 'simd128', workers: 1 },
  { isa: 'simd128', workers: 3 },
  { isa: 'plain', workers: 1 },
  { isa: 'plain', workers: 3 },
];

function options() {
  const words = process.argv.slice(2);
  const found = { program: 'build/cuvette', wasm: 'build/wasm', browsers: [], size: '160x120', scenes: [] };
  while (words.length) {
    const word = words.shift();
    if (word === '--browser') found.browsers.push(words.shift());
    else if (word.startsWith('--')) found[word.slice(2)] = words.shift();
    else found.scenes.push(word);
  }
  if (!found.browsers.length) found.browsers.push('chromium');
  return found;
}

const SCENES = 'experiments/scenes';

function filesBelow(folder) {
  return readdirSync(folder, { recursive: true })
    .map((name) => join(folder, name))
    .filter((path) => statSync(path).isFile());
}

/** The script of the page: renders every scene of the job in turn. */
async function work() {
  const job = await (await fetch('/job.json')).json();
  const files = await Promise.all(
    job.files.map(async (name) => ({
      name,
      bytes: new Uint8Array(await (await fetch(`/files/${name}`)).arrayBuffer()),
    })),
  );
  for (const run of job.runs) {
    const worker = new Worker(`/wasm/${run.isa}/worker.js`);
    const replies = new Map();
    let image = null;
    let state = null;
    let wake = () => {};
    let last = 0;
    worker.onmessage = ({ data }) => {
      if (data.failed) throw new Error(data.failed);
      if (data.event === 'image') image = JSON.parse(data.value);
      if (data.event === 'state') state = JSON.parse(data.value);
      if (data.id) replies.get(data.id)(data);
      wake();
    };
    const ask = (method, path, body) =>
      new Promise((resolve) => {
        replies.set(++last, (reply) => {
          const value = JSON.parse(new TextDecoder().decode(reply.bytes));
          resolve({ status: reply.status, value });
        });
        worker.postMessage({ id: last, method, path, body: body ? JSON.stringify(body) : null });
      });
    const wasm = await (await fetch(`/wasm/${run.isa}/cuvette.wasm`)).arrayBuffer();
    worker.postMessage({ boot: { wasm, files, scene: null, workers: run.workers } });
    for (const scene of job.scenes) {
      const answer = { ...run, scene };
      const opened = await ask('POST', '/api/open', { file: scene });
      const began = performance.now();
      const set = { 'render.width': job.width, 'render.height': job.height };
      const changed = opened.status < 400 ? await ask('POST', '/api/set', { set }) : opened;
      if (changed.status < 400) {
        const done = () =>
          (image?.final && image.generation >= changed.value.generation) ||
          (state?.trouble && state.generation >= changed.value.generation);
        while (!done()) await new Promise((resolve) => (wake = resolve));
        if (image?.final && image.generation >= changed.value.generation)
          Object.assign(answer, { film: image.film_hash, rays: image.rays });
        else answer.error = state.trouble.error;
      } else answer.error = changed.value.error;
      answer.ms = performance.now() - began;
      await fetch('/result', { method: 'POST', body: JSON.stringify(answer) });
    }
    worker.terminate();
  }
  await fetch('/result', { method: 'POST', body: JSON.stringify({ end: true }) });
}

const TYPES = { js: 'text/javascript', wasm: 'application/wasm', json: 'application/json' };

function serve({ wasm }, job, take) {
  const page = `<!doctype html><meta charset="utf-8"><title>films</title><script>(${work})().catch((error) =>
    fetch('/result', { method: 'POST', body: JSON.stringify({ failed: String(error) }) }));</script>`;
  const server = createServer((request, reply) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    if (request.method === 'POST') {
      let text = '';
      request.on('data', (tile) => (text += tile));
      request.on('end', () => {
        reply.end();
        take(JSON.parse(text));
      });
      return;
    }
    const send = (bytes, type) => {
      reply.setHeader('Content-Type', type);
      reply.end(bytes);
    };
    if (path === '/') send(page, 'text/html');
    else if (path === '/job.json') send(JSON.stringify(job), TYPES.json);
    else if (path.startsWith('/wasm/'))
      send(readFileSync(join(wasm, path.slice(6))), TYPES[path.split('.').pop()] ?? 'text/plain');
    else if (path.startsWith('/files/') && job.files.includes(path.slice(7)))
      send(readFileSync(join('experiments', path.slice(7))), 'application/octet-stream');
    else {
      reply.statusCode = 404;
      reply.end();
    }
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

/** Runs a browser without a window until the page has sent everything. */
function commandOf(browser, profile, address) {
  return /firefox/.test(browser)
    ? ['--headless', '--no-remote', '--profile', profile, address]
    : ['--headless=new', '--no-sandbox', '--disable-gpu', `--user-data-dir=${profile}`, address];
}

async function run(browser, given, job, expected) {
  const profile = mkdtempSync(join(tmpdir(), 'cuvette-browser-'));
  const counts = { passed: 0, failed: 0 };
  let end;
  const ended = new Promise((resolve) => (end = resolve));
  const server = await serve(given, job, (answer) => {
    if (answer.end) return end();
    if (answer.failed) {
      counts.failed++;
      console.log(`not ok - ${browser}: ${answer.failed}`);
      return end();
    }
    const wanted = expected.get(answer.scene);
    const equal = answer.film === wanted.film && (answer.rays === undefined || answer.rays === wanted.rays);
    counts[equal ? 'passed' : 'failed']++;
    const what = equal
      ? answer.film
      : `${answer.error ?? `${answer.film} ${answer.rays}`}, not ${wanted.film} ${wanted.rays}`;
    console.log(
      `${equal ? 'ok' : 'not ok'} - ${browser} ${answer.isa} ${answer.workers}: ${answer.scene} ${what}` +
        ` (${(answer.ms / 1000).toFixed(2)} s)`,
    );
    return undefined;
  });
  const address = `http://127.0.0.1:${server.address().port}/`;
  const child = spawn(browser, commandOf(browser, profile, address), { stdio: 'ignore', detached: true });
  child.on('error', (error) => {
    counts.failed++;
    console.log(`not ok - ${browser}: ${error.message}`);
    end();
  });
  const late = setTimeout(() => {
    counts.failed++;
    console.log(`not ok - ${browser}: not finished in ${LIMIT_MS / 1000} s`);
    end();
  }, LIMIT_MS);
  await ended;
  clearTimeout(late);
  try {
    process.kill(-child.pid, 'SIGKILL');
  } catch {
    /* it has ended */
  }
  server.close();
  server.closeAllConnections();
  rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
  return counts;
}

const given = options();
const [width, height] = given.size.split('x').map(Number);
const scenes = given.scenes.length
  ? given.scenes
  : readdirSync(SCENES)
      .filter((name) => name.endsWith('.yaml'))
      .map((name) => `scenes/${name}`);
const expected = new Map();
for (const scene of scenes) {
  const words = [
    'render',
    join('experiments', scene),
    '--set',
    `render.width=${width}`,
    '--set',
    `render.height=${height}`,
  ];
  const {
    film_hash: film,
    rays: { total: rays },
  } = JSON.parse(execFileSync(given.program, [...words, '--json'], { stdio: ['ignore', 'pipe', 'ignore'] }));
  expected.set(scene, { film, rays });
}
const files = [...filesBelow(SCENES), ...filesBelow('experiments/hands')].map((path) => relative('experiments', path));
const all = { passed: 0, failed: 0 };
for (const browser of given.browsers) {
  const counts = await run(browser, given, { runs: RUNS, scenes, files, width, height }, expected);
  all.passed += counts.passed;
  all.failed += counts.failed;
}
console.log(`${all.passed} passed, ${all.failed} failed`);
process.exit(all.failed ? 1 : 0);
