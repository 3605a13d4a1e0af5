/* What the tests of the WebAssembly modules share: the modules of `make wasm`, the native program, the shipped scenes.
 *
 * exports: ISAS, cuvetteOf(isa), factoryOf(isa), scenes, nameOf, settingsOf(name), native(name, settings),
 *          readScene(cuvette, name, settings), filesOf(text), textOf(name), UNSUPPORTED, ROOT */

import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { load } from '../../src/wasm/api/cuvette.js';

export const ROOT = fileURLToPath(new URL('../../', import.meta.url));
export const ISAS = (process.env.WASM_ISAS || 'simd128 plain').split(' ');
const SCENES = `${ROOT}experiments/scenes`;

/* Shipped scenes that no browser renders, with the reason. */
export const UNSUPPORTED = {};

export const scenes = readdirSync(SCENES)
  .filter((file) => file.endsWith('.yaml'))
  .map((file) => file.slice(0, -5))
  .sort();

export const placesOf = (isa) => ({
  module: `${ROOT}build/wasm/${isa}/cuvette.js`,
  wasm: `${ROOT}build/wasm/${isa}/cuvette.wasm`,
});
export const cuvetteOf = (isa) => load(placesOf(isa));

const compiled = {};

/* A module without the API: host is what it calls (src/wasm/imports.js). */
export async function moduleOf(isa, host = {}) {
  const { module, wasm } = placesOf(isa);
  const factory = createRequire(import.meta.url)(module);
  compiled[isa] ??= await WebAssembly.compile(readFileSync(wasm));
  return factory({
    host,
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(compiled[isa], imports).then((instance) => done(instance, compiled[isa]));
      return {};
    },
  });
}

/* Scenes whose frame takes less than a second at their own size; the others are rendered small. */
const WHOLE = new Set(['absorber', 'chequer', 'coin', 'malus', 'rod', 'rod-leaning', 'magnifier', 'slime']);
const SMALL = { 'render.width': 64, 'render.height': 48 };
/* Their photons take long at any size. */
const FEWER_PHOTONS = { caustic: 40000, 'sunlit-glass': 40000 };

export function settingsOf(name) {
  const photons = name in FEWER_PHOTONS ? { 'render.photons': FEWER_PHOTONS[name] } : {};
  return { ...(WHOLE.has(name) ? {} : SMALL), ...photons };
}

export const textOf = (name) => readFileSync(`${SCENES}/${name}.yaml`, 'utf8');

/* The files that a scene names, {name below experiments/: bytes}. */
export function filesOf(text) {
  const files = {};
  for (const [word] of text.matchAll(/[\w./-]+\.\w+/g)) {
    const path = join('scenes', word);
    if (existsSync(`${ROOT}experiments/${path}`)) files[path] = readFileSync(`${ROOT}experiments/${path}`);
  }
  return files;
}

export function readScene(cuvette, name, settings = settingsOf(name)) {
  const text = textOf(name);
  const scene = cuvette.Scene.read(text, { name: `scenes/${name}.yaml`, files: filesOf(text) });
  for (const [path, value] of Object.entries(settings)) scene.set(path, value);
  return scene;
}

const sets = (settings) => Object.entries(settings).flatMap(([path, value]) => ['--set', `${path}=${value}`]);

export function runNative(scene, settings = {}, environment = {}) {
  const options = { encoding: 'utf8', maxBuffer: 1 << 26, env: { ...process.env, ...environment } };
  const all = { 'render.threads': 1, ...settings };
  return JSON.parse(execFileSync(`${ROOT}build/cuvette`, ['render', '--json', scene, ...sets(all)], options));
}

const known = new Map();

/* {hash, rays} of the native program. */
export function native(name, settings = settingsOf(name)) {
  if (!known.has(name)) {
    const { film_hash: hash, rays, total_internal, cut } = runNative(`${SCENES}/${name}.yaml`, settings);
    known.set(name, { hash, rays, total_internal, cut: [cut.depth.rays, cut.weight.rays] });
  }
  return known.get(name);
}
