/* Starts the worker of a page without a server. A site may say in globalThis.cuvetteEngine where the parts are; without
 * it they are in the folder engine next to the page:
 *   worker    address or text of its script                                         engine/lab_worker.js
 *   script    {simd128, plain}: addresses or texts of cuvette.js                    engine/simd128/cuvette.js, ..
 *   module    {simd128, plain}: addresses or bytes of cuvette.wasm                  engine/simd128/cuvette.wasm, ..
 *   files     the laboratory's folder: {NAME: text or {base64}}, or its address     engine/files.json
 *   scene     the file that is opened; the page's address may name another (?scene=NAME); null: none
 *   workers   workers that trace tiles; default: one for each processor
 * exports: startWorker() -> promise of the worker, which has got its first message */

const WORKERS_MAX = 8; /* each has a memory of its own */

/* A module with one function that uses a 128-bit vector: (v128.const 0) (drop). */
const VECTOR = [0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 23, 1, 21, 0, 253, 12];
const hasVectors = () => WebAssembly.validate(new Uint8Array([...VECTOR, ...new Array(16).fill(0), 26, 11]));

export async function startWorker() {
  const given = globalThis.cuvetteEngine ?? {};
  const set = hasVectors() ? 'simd128' : 'plain';
  const worker = new Worker(scriptAddress(given.worker ?? 'engine/lab_worker.js'));
  const files = await unpack(given.files ?? 'engine/files.json');
  worker.postMessage({
    boot: {
      script: scriptAddress(given.script?.[set] ?? `engine/${set}/cuvette.js`),
      module: moduleOf(given.module?.[set] ?? `engine/${set}/cuvette.wasm`),
      files,
      scene: new URLSearchParams(location.search).get('scene') ?? given.scene ?? null,
      workers: given.workers ?? Math.min(WORKERS_MAX, Math.max(1, navigator.hardwareConcurrency || 1)),
    },
  });
  return worker;
}

const absolute = (address) => new URL(address, document.baseURI).href;
const moduleOf = (module) => (typeof module === 'string' ? absolute(module) : module);

/* A page that is opened as a file may start workers from its own text only. */
function scriptAddress(script) {
  if (!script.includes('\n')) return absolute(script);
  return URL.createObjectURL(new Blob([script], { type: 'text/javascript' }));
}

async function unpack(files) {
  const named = typeof files === 'string' ? await (await fetch(absolute(files))).json() : files;
  const encoder = new TextEncoder();
  return Object.entries(named).map(([name, content]) => ({
    name,
    bytes:
      typeof content === 'string'
        ? encoder.encode(content)
        : Uint8Array.from(atob(content.base64), (letter) => letter.charCodeAt(0)),
  }));
}
