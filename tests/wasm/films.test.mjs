/* The films of all shipped scenes, and their ray counts, are those of the native program, with and without vectors. */

import assert from 'node:assert/strict';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { ISAS, UNSUPPORTED, cuvetteOf, native, readScene, runNative, scenes } from './fixture.mjs';

const counted = ({ camera, reflect, refract, shadow, photon }) => ({ camera, reflect, refract, shadow, photon });

for (const isa of ISAS) {
  const loaded = cuvetteOf(isa);
  for (const name of scenes) {
    const skip = UNSUPPORTED[name];
    test(`${isa}: the film of ${name}`, { skip }, async () => {
      const cuvette = await loaded;
      assert.equal(cuvette.isa, isa);
      const scene = readScene(cuvette, name);
      const { hash, counters } = await cuvette.engine().render(scene);
      scene.destroy();
      const expected = native(name);
      assert.equal(hash, expected.hash);
      assert.deepEqual(counted(counters), counted(expected.rays));
      assert.equal(counters.total_internal, expected.total_internal);
      assert.deepEqual([counters.cut_depth, counters.cut_weight], expected.cut);
    });
  }
}

const MEASURED = {
  'crown.yml':
    'DATA:\n  - type: formula 2\n    wavelength_range: 0.3 2.5\n' +
    '    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653\n',
  'flint.agf': 
    'NM F2 2 0 1.62 36.4 0 1\n' +
    'CD 1.34533359 .00997743871 .209073176 .0470450767 .937357162 111.886764\nLD .32 2.5\n',
  'milk.csv': 'nm,1/m\n400,4\n500,1.6\n600,0.8\n700,0.4\n',
  'paint.txt': 'nm\tR\n400\t0.1\n550\t0.5\n700\t0.9\n',
  'scene.yaml':
    'render: {width: 48, height: 32, depth: 6, integrator: path, paths: 16}\n' +
    'camera: {position: [0, 1, -6], target: [0, 0, 0], fov_deg: 40}\n' +
    'lights: {lamp: {position: [4, 7, -5]}}\n' +
    'data: {crown: {file: crown.yml}, flint: {file: flint.agf, glass: F2}, milk: {file: milk.csv},\n' +
    '  paint: {file: paint.txt}}\n' +
    'solids:\n' +
    '  ball: {shape: sphere, position: [-1, 0, 0], transparency: 1, medium: data, medium_data: crown,\n' +
    '    scatter_data: milk}\n' +
    '  other: {shape: sphere, position: [1.2, 0, 0], transparency: 1, medium: data, medium_data: flint,\n' +
    '    absorb_data: milk}\n' +
    '  wall: {shape: plane, position: [0, -1, 0], diffuse: 1, color_data: paint}\n',
};

test('scenes with files of optical data', async (t) => {
  const folder = mkdtempSync(join(tmpdir(), 'cuvette-wasm-'));
  t.after(() => rmSync(folder, { recursive: true }));
  for (const [file, text] of Object.entries(MEASURED)) writeFileSync(join(folder, file), text);
  const cuvette = await cuvetteOf(ISAS[0]);
  const bytes = ([file, text]) => [file, new TextEncoder().encode(text)];
  const files = Object.fromEntries(Object.entries(MEASURED).map(bytes));
  for (const spectrum of ['rgb', 'spectral']) {
    const scene = cuvette.Scene.read(MEASURED['scene.yaml'], { name: 'scene.yaml', files });
    scene.set('render.spectrum', spectrum);
    const { hash } = await cuvette.engine().render(scene);
    scene.destroy();
    assert.equal(hash, runNative(join(folder, 'scene.yaml'), { 'render.spectrum': spectrum }).film_hash);
  }
});
