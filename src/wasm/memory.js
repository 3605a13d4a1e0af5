/* Starts the module of a worker, and copies bytes to its memory. */
'use strict';

/* compiled: a WebAssembly.Module; host: the functions that the module calls (imports.js). Emscripten does not notice a
 * failure of the hook instantiateWasm, so the hook rejects the promise. */
const instantiate = (compiled, host) =>
  new Promise((resolve, reject) => {
    cuvette({
      host,
      instantiateWasm(imports, done) {
        WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled), reject);
        return {};
      },
    }).then(resolve, reject);
  });

/* Calls use(address, size) with a copy of the bytes in the module's memory, followed by a 0. */
function withBytes(module, bytes, use) {
  const address = module._malloc(bytes.length + 1);
  if (!address) throw new Error('out of memory');
  module.HEAPU8.set(bytes, address);
  module.HEAPU8[address + bytes.length] = 0;
  try {
    return use(address, bytes.length);
  } finally {
    module._free(address);
  }
}

const encoder = new TextEncoder();
const withText = (module, text, use) => withBytes(module, encoder.encode(text), use);
