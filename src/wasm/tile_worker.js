/* A tile worker: renders tiles for the laboratory's worker.
 *
 * laboratory -> worker  {tiles: WebAssembly.Module}, first; {scene: bytes}, whose error is in the next answer;
 *                       {order: bytes}
 * worker -> laboratory  {traced: bytes} per order, or {failed: text} */

let tracer = null; /* emscripten's module */

async function startTiles(compiled) {
  tracer = await instantiate(compiled, {});
}

function traceTiles(order) {
  const size = tracer._malloc(4);
  const answer = withBytes(tracer, order, (address, length) => tracer._wasm_tiles_trace(address, length, size));
  const length = new DataView(tracer.HEAPU8.buffer).getUint32(size, true);
  const bytes = tracer.HEAPU8.slice(answer, answer + length);
  tracer._free(size);
  postMessage({ traced: bytes }, [bytes.buffer]);
}

function tileMessage({ scene, order }) {
  if (order) traceTiles(order);
  else withBytes(tracer, scene, (address, size) => tracer._wasm_tiles_scene(address, size));
}
