/* Starts the engine of the site's page before the page's own modules are there; engine_boot.js describes what
 * globalThis.cuvetteEngine tells. The laboratory in one file has the parts in elements of the page, each the base64 of
 * its gzip: a page that is opened as a file can load nothing else.
 * globalThis.cuvetteDocument() is the text of that file as it was loaded, for pages that hold it (live_page.js). */

import { startWorker } from '../page/engine_boot.js';

const FIRST_SCENE = 'scenes/rod.yaml';

const part = (name) => document.getElementById(`cuvette-${name}`);
const opensLink = part('scene') || /^#(scene|lesson)=/.test(location.hash);

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

function keepDocument() {
  const kept = document.documentElement.cloneNode(true);
  kept.querySelector('#cuvette-scene')?.remove();
  globalThis.cuvetteDocument = () => `<!doctype html>\n${kept.outerHTML}`;
}

const oneFile = Boolean(part('module'));
if (!oneFile && location.protocol === 'file:')
  location.replace(`../laboratory.html${location.search}${location.hash}`); // nothing can be fetched here
else {
  if (oneFile) keepDocument();
  globalThis.cuvetteEngine = { scene: opensLink ? null : FIRST_SCENE, ...(oneFile && partsOfPage()) };
  globalThis.cuvetteEngine.started = startWorker();
  globalThis.cuvetteEngine.started.catch(() => undefined); // the page tells it
}
