/* The rows of films.sh for the modules of make wasm:
 *   node films.mjs MODULES < LINES        lines "SCENE PARAMETER=VALUE"; MODULES: build/wasm
 * Writes a line for each module and scene: scene, film hash, ray counts, instruction set; separated by commas. */

import { existsSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { load } from '../src/wasm/api/cuvette.js';

const here = fileURLToPath(new URL('.', import.meta.url));
const modules = resolve(process.argv[2]);
const settings = new Map();
for (const line of readFileSync(0, 'utf8').split('\n').filter(Boolean)) {
  const [scene, setting] = line.split(' ');
  settings.set(scene, [...(settings.get(scene) ?? []), setting.split('=')]);
}

/* The files that a scene names, {name below experiments/: bytes}. */
function filesOf(text) {
  const files = {};
  for (const [word] of text.matchAll(/[\w./-]+\.\w+/g)) {
    const path = join('scenes', word);
    if (existsSync(here + path)) files[path] = readFileSync(here + path);
  }
  return files;
}

for (const isa of ['simd128', 'plain']) {
  const cuvette = await load({
    module: `${modules}/${isa}/cuvette.js`,
    wasm: `${modules}/${isa}/cuvette.wasm`,
  });
  for (const [name, sets] of settings) {
    const text = readFileSync(`${here}scenes/${name}.yaml`, 'utf8');
    const scene = cuvette.Scene.read(text, { name: `scenes/${name}.yaml`, files: filesOf(text) });
    for (const [path, value] of sets) {
      const number = Number(value);
      scene.set(path, Number.isNaN(number) ? value : number);
    }
    const { hash, counters } = await cuvette.engine().render(scene);
    scene.destroy();
    const { camera, reflect, refract, shadow, photon, total_internal: inside } = counters;
    console.log([name, hash, camera, reflect, refract, shadow, photon, inside, cuvette.isa].join());
  }
}
