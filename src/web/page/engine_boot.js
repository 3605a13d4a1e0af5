/* Starts the worker of a page without a server (src/wasm/lab_worker.js). Its parts come from the folder engine next to
 * the page, or from globalThis.cuvetteEngine, where a site may give some of them, or promises of them:
 *   worker    {simd128, plain}: text of the script of all workers     engine/simd128/worker.js, ..
 *   wasm      {simd128, plain}: bytes of the module                   engine/simd128/cuvette.wasm, ..
 *   files     {NAME: text or {base64}}: the laboratory's folder       engine/files.json
 *   scene     the file that is opened; the page's address may name another (?scene=NAME); null: none
 *   workers   workers that trace tiles; default: one for each processor
 * exports: startWorker() -> promise of the worker, which has got its first message; an error may have a remedy */

const WORKERS_MAX = 8; /* each has a memory of its own */

const OF_A_FILE =
  'a page that is opened as a file cannot load others: open the one that holds all, or use a web server';

/* A module with one function that uses a 128-bit vector: (v128.const 0) (drop). */
const VECTOR = [0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 23, 1, 21, 0, 253, 12];
const hasVectors = () => WebAssembly.validate(new Uint8Array([...VECTOR, ...new Array(16).fill(0), 26, 11]));

export async function startWorker() {
  const given = globalThis.cuvetteEngine ?? {};
  const set = hasVectors() ? 'simd128' : 'plain';
  const [script, wasm, named] = await Promise.all([
    given.worker?.[set],
    compiled(given.wasm?.[set] ?? part(`${set}/cuvette.wasm`)),
    given.files ?? part('files.json').then((reply) => reply.json()),
  ]);
  const worker = new Worker(script ? addressOf(script) : new URL(`engine/${set}/worker.js`, document.baseURI));
  worker.postMessage({
    boot: {
      wasm,
      files: Object.entries(named).map(([name, content]) => ({ name, bytes: bytesOf(content) })),
      scene: new URLSearchParams(location.search).get('scene') ?? given.scene ?? null,
      workers: given.workers ?? Math.min(WORKERS_MAX, Math.max(1, navigator.hardwareConcurrency || 1)),
    },
  });
  return worker;
}

async function part(name) {
  const reply = await fetch(new URL(`engine/${name}`, document.baseURI)).catch(() => null);
  if (reply?.ok) return reply;
  const why = new Error(`engine/${name} cannot be loaded${reply ? `: status ${reply.status}` : ''}`);
  why.remedy = location.protocol === 'file:' ? OF_A_FILE : 'check the connection, and reload the page';
  throw why;
}

async function compiled(source) {
  const got = await source;
  return WebAssembly.compile(got instanceof Response ? await got.arrayBuffer() : got);
}

const addressOf = (text) => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));

function bytesOf(content) {
  if (typeof content === 'string') return new TextEncoder().encode(content);
  return Uint8Array.from(atob(content.base64), (letter) => letter.charCodeAt(0));
}
