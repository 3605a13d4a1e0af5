/* The last part of a worker's script, which is one file: emscripten's cuvette.js, memory.js, lab_worker.js,
 * tile_worker.js and this. The first message says what the worker is: {boot} a laboratory, {tiles} a tile worker. */

const fail = (error) => postMessage({ failed: String(error?.message || error) });
let handle = null; /* handles later messages */
let started = null;

onmessage = ({ data }) => {
  if (!started) {
    handle = data.boot ? labMessage : tileMessage;
    started = data.boot ? startLab(data.boot) : startTiles(data.tiles);
    started.catch(fail);
  } else {
    started.then(() => handle(data)).catch(fail);
  }
};
