// The laboratory as plain files, put together from the sources of the page and the folder of `make wasm`: what a host
// of static pages serves for it.
import { readFile } from 'node:fs/promises';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const source = join(dirname(fileURLToPath(import.meta.url)), '..', '..', 'src');
const META = '<meta name="cuvette-engine" content="browser" />';

/** wasm: the folder with simd128/{worker.js,cuvette.wasm} and plain. Returns {folder, lab: the path of the page, files:
 * that of the laboratory's files, lessons: the folder of the program's own, made: other paths}, see browser_lab.mjs. */
export function siteOf(wasm) {
  const page = join(source, 'web', 'page');
  const made = {
    '/index.html': async () =>
      (await readFile(join(page, 'index.html'), 'utf8')).replace('<title>', (title) => `${META}${title}`),
  };
  for (const set of ['simd128', 'plain'])
    for (const name of ['worker.js', 'cuvette.wasm'])
      made[`/engine/${set}/${name}`] = () => readFile(join(wasm, set, name));
  return {
    folder: page,
    lab: '/',
    files: '/engine/files.json',
    lessons: join(source, '..', 'experiments', 'lessons'),
    made,
  };
}
