/* Starts the engine of the site's page before the page's modules are loaded; engine_boot.js describes
 * globalThis.cuvetteEngine. In laboratory.html the parts are elements of the page, compressed by gzip and encoded in
 * base64, because a page that is opened as a file cannot load other files.
 * globalThis.cuvetteDocument() is a promise of the text of laboratory.html, for saved pages that contain it
 * (save_file.js). */

import { startWorker } from '../page/shared/engine_boot.js';

const FIRST_SCENE = 'scenes/rod.yaml';
const ONE_FILE = '../laboratory.html';

const part = (name) => document.getElementById(`cuvette-${name}`);
const opensLink = part('scene') || /^#(scene|lesson)=/.test(location.hash);
const opensFirst = !opensLink && !new URLSearchParams(location.search).has('scene');
const MEGABYTE = 1e6;

/* Under the first image (bundle.py), which is shown until the engine has rendered one (view.js). */
function showProgress(loaded, all) {
  const place = document.querySelector('.first-progress');
  if (!place || !all) return;
  const [of, is] = [all, loaded].map((bytes) => (bytes / MEGABYTE).toFixed(1));
  place.querySelector('progress').value = loaded / all;
  place.querySelector('span').textContent = `${is} / ${of} MB`;
}

/* fetch decodes base64 faster than a script could. */
async function unpack(name) {
  const packed = await fetch(`data:;base64,${part(name).textContent}`);
  return new Response(packed.body.pipeThrough(new DecompressionStream('gzip')), {
    headers: { 'Content-Type': 'application/wasm' },
  });
}

/* Promises: the engine is compiled while the rest is unpacked. */
const partsOfPage = () => ({
  worker: unpack('worker').then((reply) => reply.text()),
  module: unpack('module'),
  files: unpack('files').then((reply) => reply.json()),
});

/* Keeps the document as it was loaded, before the page changes it. */
function keepDocument() {
  const kept = document.documentElement.cloneNode(true);
  kept.querySelector('#cuvette-scene')?.remove();
  globalThis.cuvetteDocument = async () => `<!doctype html>\n${kept.outerHTML}`;
}

async function loadDocument() {
  const reply = await fetch(ONE_FILE);
  if (!reply.ok) throw new Error(`${ONE_FILE}: status ${reply.status}`);
  return reply.text();
}

const oneFile = Boolean(part('module'));
if (!oneFile && location.protocol === 'file:')
  location.replace(`${ONE_FILE}${location.search}${location.hash}`); // nothing can be fetched here
else {
  if (oneFile) keepDocument();
  else globalThis.cuvetteDocument = loadDocument;
  globalThis.cuvetteEngine = {
    scene: opensLink ? null : FIRST_SCENE,
    ...(oneFile ? partsOfPage() : { packed: true, progress: showProgress }),
  };
  document.documentElement.toggleAttribute('data-first', opensFirst);
  globalThis.cuvetteEngine.started = startWorker();
  globalThis.cuvetteEngine.started.catch(() => undefined); // the page reports it
}
