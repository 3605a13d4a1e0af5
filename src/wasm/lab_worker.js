/* The laboratory's worker: it receives its module and its files in the first message, starts tile workers, and answers
 * the page's requests (page/shared/engine.js).
 *
 * page -> worker  {boot: {wasm, files, scene, workers, script}}
 *                   wasm: a WebAssembly.Module, or the bytes of one; files: [{name, bytes}]; scene: a name, or null for
 *                   an empty room; workers: the number of tile workers; script: the text of this script, if the page
 *                   was opened as a file, whose address workers may not use
 *                 {id, method, path, body}    body: JSON text or null
 *                 {file: {name, bytes}}       adds a file to the folder
 *                 {memory: true}              requests the size of the module's memory
 * worker -> page  {ready: true, isa} or {failed: text}
 *                 {memory: bytes}
 *                 {id, status, headers, bytes}
 *                 {event, value}              value: JSON text */

const FOLDER = '/laboratory';

let lab = null; /* emscripten's module */
let scheduled = false;
let later = 0; /* a timer */

/* --- files --- */

function putFile({ name, bytes }) {
  const parts = `${FOLDER}/${name}`.split('/');
  for (let i = 2; i < parts.length; i++) {
    const folder = parts.slice(0, i).join('/');
    if (!lab.FS.analyzePath(folder).exists) lab.FS.mkdir(folder);
  }
  lab.FS.writeFile(parts.join('/'), bytes);
}

/* --- turns --- */

/* A message that the worker sends to itself arrives after the pending messages, without the delay of a timer. */
const bell = new MessageChannel();
bell.port1.onmessage = runTurn;

function schedule() {
  if (scheduled) return;
  scheduled = true;
  bell.port2.postMessage(null);
}

function runTurn() {
  scheduled = false;
  clearTimeout(later);
  const wait_ms = lab._wasm_lab_turn();
  if (wait_ms === 0) schedule();
  else if (wait_ms > 0) later = setTimeout(runTurn, wait_ms);
}

/* --- tile workers --- */

const tileWorkers = [];

function startTileWorker(compiled, address) {
  const worker = new Worker(address);
  const number = tileWorkers.push(worker) - 1;
  worker.postMessage({ tiles: compiled });
  const lose = () => {
    worker.terminate();
    lab._wasm_lab_lost(number);
    schedule();
  };
  worker.onmessage = ({ data }) => {
    if (data.failed) lose();
    else withBytes(lab, data.traced, (address, size) => lab._wasm_lab_traced(number, address, size));
    schedule();
  };
  worker.onerror = (event) => {
    event.preventDefault?.();
    lose();
  };
}

/* The functions that the module calls (imports.js). */
const host = {
  reply: (id, status, headers, bytes) => postMessage({ id, status, headers, bytes: bytes.buffer }, [bytes.buffer]),
  event: (event, value) => postMessage({ event, value }),
  send: (worker, kind, bytes) =>
    tileWorkers[worker].postMessage(kind === 0 ? { scene: bytes } : { order: bytes }, [bytes.buffer]),
};

/* --- messages of the page --- */

async function startLab({ wasm, files, scene, workers, script }) {
  const compiled = wasm instanceof WebAssembly.Module ? wasm : await WebAssembly.compile(wasm);
  lab = await instantiate(compiled, host);
  lab.FS.mkdir(FOLDER);
  lab.FS.chdir(FOLDER);
  files.forEach(putFile);
  const address = script ? URL.createObjectURL(new Blob([script], { type: 'text/javascript' })) : self.location.href;
  for (let i = 0; i < workers; i++) startTileWorker(compiled, address);
  const code = withText(lab, FOLDER, (folder) =>
    withText(lab, scene ? `${FOLDER}/${scene}` : '', (name) => lab._wasm_lab_start(folder, name, workers)),
  );
  if (code !== 0) throw new Error(lab.UTF8ToString(lab._wasm_why()));
  postMessage({ ready: true, isa: lab.UTF8ToString(lab._wasm_isa()) });
  schedule();
}

function labMessage({ id, method, path, body, file, memory }) {
  if (file) {
    putFile(file);
    return;
  }
  if (memory) {
    postMessage({ memory: lab.HEAPU8.length });
    return;
  }
  withText(lab, method, (how) =>
    withText(lab, path, (target) =>
      withText(lab, body ?? '', (text, size) => lab._wasm_lab_request(id, how, target, text, size)),
    ),
  );
  schedule();
}
