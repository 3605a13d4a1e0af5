/* Starts the worker of a page without a server (src/wasm/lab_worker.js). Its parts are in the folder engine next to the
 * page, or a site has some of them in globalThis.cuvetteEngine, as values or promises:
 *   started   the worker, if the site has started it (src/web/site/boot.js)
 *   worker    the text of its script                                            engine/simd128/worker.js, or plain
 *   module    the Response with its module, which needs 128-bit vectors         engine/simd128/cuvette.wasm, or plain
 *   files     the laboratory's folder: {NAME: text or {base64}}                 engine/files.json
 *   scene     the file that is opened; the page's address may name another (?scene=NAME); null: none
 *   packed    whether the files of engine/ are also there compressed by gzip, as NAME.packed: a host need not compress
 *   progress  called with the bytes of the module that are loaded, and with all, 0 if that is unknown
 *   workers   workers that render tiles; default: one for each processor
 * exports: startWorker() -> promise of the worker, after its first message was sent; an error may have a remedy;
 *                           worker.early: messages from it that came before a listener */

const WORKERS_MAX = 8; /* each has its own memory */

const FILE_REMEDY =
  'open laboratory.html, which holds all parts, or use a web server: a page opened as a file cannot load files';

/* A module with one function that uses a 128-bit vector: (v128.const 0) (drop). */
const VECTOR = [0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 23, 1, 21, 0, 253, 12];
const hasVectors = () => WebAssembly.validate(new Uint8Array([...VECTOR, ...new Array(16).fill(0), 26, 11]));

const absolute = (name) => new URL(`engine/${name}`, document.baseURI).href;

export async function startWorker() {
  const site = globalThis.cuvetteEngine ?? {};
  const set = hasVectors() ? 'simd128' : 'plain';
  if (site.module && set === 'plain') throw new Error('this browser is too old for the laboratory in one file');
  const compiled = compile(site.module ?? part(`${set}/cuvette.wasm`, site.progress)); /* while the script is loaded */
  const script = await (site.worker ?? (packed() ? part(`${set}/worker.js`).then((reply) => reply.text()) : null));
  const worker = new Worker(script ? textAddress(script) : absolute(`${set}/worker.js`));
  worker.early = [];
  worker.onmessage = ({ data }) => worker.early.push(data);
  worker.onerror = ({ message }) => worker.early.push({ failed: message || 'its script cannot be loaded' });
  const [wasm, files] = await Promise.all([compiled, site.files ?? part('files.json').then((reply) => reply.json())]);
  worker.postMessage({
    boot: {
      wasm,
      files: Object.entries(files).map(([name, content]) => ({ name, bytes: bytesOf(content) })),
      scene: new URLSearchParams(location.search).get('scene') ?? site.scene ?? null,
      workers: site.workers ?? Math.min(WORKERS_MAX, Math.max(1, navigator.hardwareConcurrency || 1)),
      script,
    },
  });
  return worker;
}

/* A page that is opened as a file may start workers from its own text only. */
const textAddress = (text) => URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));

const packed = () => Boolean(globalThis.cuvetteEngine?.packed && 'DecompressionStream' in globalThis);

async function part(name, progress) {
  const reply = await fetch(absolute(packed() ? `${name}.packed` : name)).catch(() => null);
  if (reply?.ok) return new Response(contentOf(reply, progress), { headers: { 'Content-Type': 'application/wasm' } });
  const why = new Error(`engine/${name} cannot be loaded${reply ? `: status ${reply.status}` : ''}`);
  why.remedy = location.protocol === 'file:' ? FILE_REMEDY : 'check the connection, and reload the page';
  throw why;
}

function contentOf(reply, progress = () => {}) {
  const all = reply.headers.has('Content-Encoding') ? 0 : Number(reply.headers.get('Content-Length'));
  let loaded = 0;
  const counter = new TransformStream({
    transform(piece, out) {
      loaded += piece.length;
      progress(loaded, all);
      out.enqueue(piece);
    },
  });
  const counted = reply.body.pipeThrough(counter);
  return packed() ? counted.pipeThrough(new DecompressionStream('gzip')) : counted;
}

/* Compiles the module while it is loaded, once for all workers. */
const compile = async (promised) => WebAssembly.compileStreaming(await promised);

function bytesOf(content) {
  if (typeof content === 'string') return new TextEncoder().encode(content);
  return Uint8Array.from(atob(content.base64), (letter) => letter.charCodeAt(0));
}
