/* Finds, compiles and starts the WebAssembly module.
 *
 * exports: instantiate({folder} or {module, wasm}), hasVectors() */

import { badInput } from './errors.js';

const inNode = typeof process === 'object' && Boolean(process.versions?.node) && process.type !== 'renderer';

/* A module whose only function uses a 128-bit vector. */
const VECTORS = [
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
];

export const hasVectors = () => WebAssembly.validate(new Uint8Array(VECTORS));

async function fetched(address) {
  const response = await fetch(address);
  if (!response.ok) throw badInput(`${address}: the server answers ${response.status}`, 'check the address');
  return response;
}

async function factoryOf(module) {
  if (typeof module === 'function') return module;
  if (inNode) {
    const { createRequire } = await import('node:module');
    return createRequire(import.meta.url)(pathOf(module));
  }
  /* cuvette.js is a classic script: an export makes it a module. */
  const text = await (await fetched(module)).text();
  const blob = URL.createObjectURL(new Blob([text, '\nexport default cuvette;'], { type: 'text/javascript' }));
  try {
    return (await import(/* webpackIgnore: true */ blob)).default;
  } finally {
    URL.revokeObjectURL(blob);
  }
}

const pathOf = (address) =>
  String(address).startsWith('file:') ? decodeURIComponent(new URL(address).pathname) : address;

async function compile(wasm) {
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (wasm instanceof ArrayBuffer || ArrayBuffer.isView(wasm)) return WebAssembly.compile(wasm);
  if (inNode) return WebAssembly.compile(await (await import('node:fs/promises')).readFile(pathOf(wasm)));
  return WebAssembly.compile(await (await fetched(wasm)).arrayBuffer());
}

function placesIn(folder) {
  const base = `${String(folder).replace(/\/$/, '')}/${hasVectors() ? 'simd128' : 'plain'}`;
  return { module: `${base}/cuvette.js`, wasm: `${base}/cuvette.wasm` };
}

export async function instantiate(options) {
  const { module, wasm } = options.folder === undefined ? options : placesIn(options.folder);
  if (!module || !wasm) throw badInput('the module is not given', 'give folder, or module and wasm');
  const [factory, compiled] = await Promise.all([factoryOf(module), compile(wasm)]);
  /* Emscripten does not notice a failure of this hook, so the hook rejects the promise. */
  return new Promise((resolve, reject) => {
    factory({
      instantiateWasm(imports, done) {
        WebAssembly.instantiate(compiled, imports).then((instance) => done(instance, compiled), reject);
        return {};
      },
    }).then(resolve, reject);
  });
}
