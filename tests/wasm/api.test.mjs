/* The JavaScript API: errors as the command's, cancellation, tiles, rays, slimes, a worker, memory. */

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { Worker } from 'node:worker_threads';
import { connect } from '../../src/wasm/api/cuvette.js';
import { Memory } from '../../src/wasm/api/memory.js';
import { Scene } from '../../src/wasm/api/scene.js';
import { ISAS, ROOT, cuvetteOf, moduleOf, native, placesOf, readScene, textOf } from './fixture.mjs';

const SMALL = { 'render.width': 32, 'render.height': 24 };

/* The words of Random123's known answers (kat_vectors, philox4x32 10): counter, key, result. */
const PHILOX = [
  ['00000000 00000000 00000000 00000000', '00000000 00000000', '6627e8d5 e169c58d bc57ac4c 9b00dbd8'],
  ['ffffffff ffffffff ffffffff ffffffff', 'ffffffff ffffffff', '408f276d 41c83b0e a20bc7c6 6d5451fd'],
  ['243f6a88 85a308d3 13198a2e 03707344', 'a4093822 299f31d0', 'd16cfe09 94fdcceb 5001e420 24126ea1'],
];
const words = (text) => text.split(' ').map((word) => parseInt(word, 16));

/* What the command says of a file, without its name and the folder. */
function refusal(text) {
  const folder = mkdtempSync(join(tmpdir(), 'cuvette-wasm-'));
  const file = join(folder, 'bad.yaml');
  writeFileSync(file, text);
  try {
    execFileSync(`${ROOT}build/cuvette`, ['render', '--json', file], { encoding: 'utf8', stdio: 'pipe' });
  } catch (error) {
    return error.stderr.trim().replace(`cuvette: `, '').replaceAll(`${folder}/`, '');
  } finally {
    rmSync(folder, { recursive: true });
  }
  return '';
}

const BAD = [
  'render: {depht: 3}\n',
  'title: a\nsolids:\n  ball: {shape: sphere, radius: -1}\n',
  'solids: {ball: {shape: spere}}\n',
  'lights: [\n',
  'render: {width: 0}\n',
  'materials: {a: {ior: x}}\n',
];

/* The largest difference of two reports on lenses, relative to the largest number of a column. Point images are of
 * single precision. */
function differenceOf(a, b) {
  assert.deepEqual(Object.keys(b), Object.keys(a));
  let most = 0;
  for (const [section, { values, units }] of Object.entries(a)) {
    assert.deepEqual(b[section].units, units);
    const single = /encircled|psf|mtf-diffraction|wavefront/.test(section) ? 1e-3 : 1;
    for (const [name, column] of Object.entries(values)) {
      const [one, other] = [[column].flat(), [b[section].values[name]].flat()];
      assert.equal(other.length, one.length, `${section} ${name}`);
      const size = Math.max(1e-6, ...one.map((value) => Math.abs(value ?? 0)));
      for (const [i, value] of one.entries()) {
        assert.equal(other[i] === null, value === null, `${section} ${name} ${i}`);
        most = Math.max(most, (single * Math.abs(value - other[i])) / size);
      }
    }
  }
  return most;
}

for (const isa of ISAS)
  describe(isa, () => {
    let cuvette;
    before(async () => (cuvette = await cuvetteOf(isa)));

    test('random numbers are those of Random123', () => {
      for (const [counter, key, result] of PHILOX)
        assert.deepEqual(cuvette.random(words(key), words(counter)), words(result));
    });

    test('errors are those of the command', async () => {
      for (const text of BAD) {
        const expected = refusal(text);
        assert.match(expected, /bad\.yaml/);
        await assert.rejects(
          async () => {
            const scene = cuvette.Scene.read(text, { name: 'bad.yaml' });
            await cuvette.engine().render(scene);
          },
          (error) => {
            assert.equal(error.message, expected);
            assert.equal(error.file, 'bad.yaml');
            return error.status === 2;
          },
        );
      }
    });

    test('a scene whose files have an invalid name leaves no folder', async () => {
      const memory = new Memory(await moduleOf(isa));
      const read = (files) => Scene.read(memory, 'title: a\n', { files });
      const byte = new Uint8Array(1);
      read({ 'a/b.png': byte }).destroy();
      assert.throws(() => read({ 'c.png': byte, '../d.png': byte }), /is not a name of a file/);
      assert.throws(() => read({ e: byte, 'e/f': byte }));
      assert.deepEqual(memory.module.FS.readdir('/scenes'), ['.', '..']);
    });

    test('parameters, names, texts', () => {
      const scene = readScene(cuvette, 'rod', {});
      scene.set('render.depth', 3);
      scene.set('lamp.position', [1, 2, 3]);
      assert.equal(scene.get('render.depth'), '3');
      assert.equal(scene.get('lamp.position'), '1,2,3');
      assert.deepEqual(scene.names().solids, ['ground', 'vessel', 'liquid', 'rod']);
      const { value, unit } = scene.parameters().find(({ path }) => path === 'lamp.position');
      assert.equal(value, scene.get('lamp.position'));
      assert.equal(unit, 'scene units');
      const again = cuvette.Scene.read(scene.text());
      assert.equal(again.text(), scene.text());
      assert.deepEqual(scene.hints(), []);
      again.remove('lamp');
      assert.match(again.hints().join(), /light/);
      assert.throws(() => scene.set('rod.colour', 1), { status: 2, remedy: /./ });
      const copy = scene.clone();
      scene.destroy();
      assert.equal(copy.get('render.depth'), '3');
      assert.throws(() => scene.get('render.depth'), /destroyed/);
    });

    test('tiles cover the image; the image is that of the film', async () => {
      const scene = readScene(cuvette, 'rod', { 'render.width': 100, 'render.height': 70 });
      const filled = new Uint8ClampedArray(4 * 100 * 70);
      const shares = [];
      let coarse = 0;
      const tile = (one) => {
        if (one.coarse > 1) {
          coarse = one.coarse;
          assert.deepEqual([one.width, one.height, one.x1, one.y1], [25, 18, 100, 70]);
          return;
        }
        const row = 4 * one.width;
        for (let y = 0; y < one.height; y++)
          filled.set(one.srgb.subarray(y * row, (y + 1) * row), 4 * ((one.y0 + y) * 100 + one.x0));
      };
      const done = await cuvette.engine().render(scene, { tile, preview: 4, progress: (share) => shares.push(share) });
      assert.equal(coarse, 4);
      assert.deepEqual(done.srgb, filled);
      assert.equal(done.rgb.length, 3 * 100 * 70);
      const encoded = (x) => Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
      for (const i of [0, 999, 5000])
        for (const k of [0, 1, 2])
          assert.equal(done.srgb[4 * i + k], Math.max(0, Math.min(255, encoded(done.rgb[3 * i + k]))));
      assert.equal(shares[0], 0);
      assert.equal(shares.at(-1), 1);
    });

    test('a render leaves the event loop free, and can be cancelled', async () => {
      const scene = readScene(cuvette, 'lens', {});
      const engine = cuvette.engine();
      let turns = 0;
      const timer = setInterval(() => turns++, 0);
      const stop = new AbortController();
      setTimeout(() => stop.abort(), 400);
      await assert.rejects(engine.render(scene, { signal: stop.signal }), { name: 'AbortError' });
      clearInterval(timer);
      assert.ok(turns > 1, `the event loop turned ${turns} times`);
      const running = engine.render(scene);
      await assert.rejects(engine.render(scene), { status: 3 });
      assert.throws(() => scene.set('render.depth', 1), { status: 3 });
      engine.cancel();
      await assert.rejects(running, { name: 'AbortError' });
      scene.set('render.depth', 1);
    });

    test('rays, fans and optics', () => {
      const scene = readScene(cuvette, 'rod', {});
      const query = scene.query();
      const ray = query.cameraRay(400.5, 300.5);
      const [hit, miss] = query.nearest([ray, { origin: [0, 5, 0], direction: [0, 1, 0] }]);
      assert.ok(hit.distance > 0 && scene.names().solids.includes(hit.solid));
      assert.equal(miss.distance, null);
      assert.equal(query.medium([0, 100, 0]), null);
      const tree = scene.trace({ pixel: [400, 300] });
      assert.deepEqual(tree.root.origin, ray.origin);
      assert.equal(query.trace(ray).root.hit.solid, hit.solid);
      assert.throws(() => query.trace({ pixel: [-1, 0] }), { status: 2 });
      const fan = scene.fan({ from: [-3, 1, 0], to: [3, 1, 0], rays: 5, width: 0.2 });
      assert.equal(fan.rays.length, 5);
      const { metrics, curves } = scene.realism();
      assert.ok(metrics.every(({ verdict }) => verdict !== 'FAIL'));
      assert.equal(scene.curve(curves[0].name)[0].length, 3);
    });

    test('the report on a lens is that of the command', () => {
      for (const name of ['cooke-triplet', 'landscape']) {
        const folder = mkdtempSync(join(tmpdir(), 'cuvette-wasm-'));
        const file = join(folder, `${name}.yaml`);
        const run = (...words) =>
          execFileSync(`${ROOT}build/cuvette`, ['lens', ...words], { encoding: 'utf8', maxBuffer: 1 << 26 });
        run(`${ROOT}experiments/lenses/${name}.csv`, '-o', file);
        const { sections } = JSON.parse(run('report', file, '--json'));
        const scene = cuvette.Scene.read(readFileSync(file, 'utf8'));
        rmSync(folder, { recursive: true });
        assert.ok(differenceOf(sections, scene.lens().sections) < 1e-9, name);
      }
      assert.throws(() => readScene(cuvette, 'rod', SMALL).lens(), /no lens/);
    });

    test('slimes: advanced in steps or at once, grabbed, moved, released', async () => {
      const scene = readScene(cuvette, 'slime', SMALL);
      const motion = scene.motion();
      const [name] = motion.names();
      await motion.advance(0.3);
      const state = motion.state(name);
      const other = readScene(cuvette, 'slime', SMALL).motion();
      await other.advance(0.1);
      await other.advance(0.3);
      assert.deepEqual(other.state(name), state);
      const above = { origin: [state.center[0], 50, state.center[2]], direction: [0, -1, 0] };
      assert.equal(motion.grab(name, { ...above, direction: [0, 1, 0] }, 0.2), null);
      const ray = findRay(motion, scene.query(), name);
      const grip = motion.grab(name, ray, 0.3);
      assert.equal(grip.where.length, 3);
      motion.move(grip.hand, [0, 0.5, 0]);
      await motion.advance(0.5);
      assert.ok(motion.state(name).held > 0);
      assert.ok(motion.state(name).center[1] > state.center[1]);
      await assert.rejects(motion.advance(0.1), { status: 2 });
    });

    test('memory does not grow: 1000 renders, 100 grabs', async () => {
      const engine = cuvette.engine();
      const once = async () => {
        const scene = readScene(cuvette, 'rod', { 'render.width': 24, 'render.height': 18 });
        await engine.render(scene, { tile() {} });
        scene.trace({ pixel: [12, 9] });
        scene.destroy();
      };
      const scene = readScene(cuvette, 'slime', SMALL);
      const grab = async () => {
        const motion = scene.motion();
        const [name] = motion.names();
        const query = scene.query();
        const found = findRay(motion, query, name);
        assert.ok(found);
        const { hand, where } = motion.grab(name, found, 0.2);
        motion.move(hand, [0, 0.2, 0]);
        await motion.advance(0.02);
        assert.ok(motion.state(name).held > 0 && where.length === 3);
        motion.release(hand);
        await motion.advance(0.04);
        assert.equal(motion.state(name).held, 0);
        assert.throws(() => motion.release(hand), { status: 2 });
        query.destroy();
        motion.destroy();
      };
      for (let i = 0; i < 20; i++) await once();
      for (let i = 0; i < 3; i++) await grab();
      const bytes = cuvette.memoryBytes;
      for (let i = 0; i < 1000; i++) await once();
      for (let i = 0; i < 100; i++) await grab();
      assert.equal(cuvette.memoryBytes, bytes);
    });
  });

/* A ray of the camera that hits the slime. */
function findRay(motion, query, name) {
  for (let y = 1; y < 24; y += 2)
    for (let x = 1; x < 32; x += 2) {
      const ray = query.cameraRay(x, y);
      if (motion.pick(name, ray)) return ray;
    }
  return null;
}

describe('in a worker', () => {
  let cuvette;
  before(async () => {
    cuvette = await connect(new Worker(`${ROOT}src/wasm/api/worker.js`), placesOf('simd128'));
  });
  after(() => cuvette.destroy());

  test('the same calls, as promises', async () => {
    assert.equal(cuvette.isa, 'simd128');
    const scene = await cuvette.Scene.read(textOf('rod'), { name: 'rod.yaml' });
    const engine = await cuvette.engine();
    const shares = [];
    let tiles = 0;
    const options = { progress: (share) => shares.push(share), tile: () => tiles++ };
    const { hash, srgb } = await engine.render(scene, options);
    assert.equal(hash, native('rod').hash);
    assert.equal(srgb.length, 4 * 800 * 600);
    assert.equal(shares.at(-1), 1);
    assert.ok(tiles > 100);
    assert.equal(await scene.get('render.depth'), '4');
    const copy = await scene.clone();
    await copy.set('render.depth', 2);
    assert.equal(await scene.get('render.depth'), '4');
    assert.equal((await (await copy.query()).cameraRay(0, 0)).origin.length, 3);
    await assert.rejects(scene.set('render.depth', 'x'), { status: 2, message: /render\.depth: .*; / });
    scene.destroy();
    await assert.rejects(scene.get('render.depth'));
  });

  test('cancellation', async () => {
    const scene = await cuvette.Scene.read(textOf('lens'), { name: 'lens.yaml' });
    const stop = new AbortController();
    const running = (await cuvette.engine()).render(scene, { signal: stop.signal, progress: () => stop.abort() });
    await assert.rejects(running, { name: 'AbortError' });
    await scene.set('render.depth', 1);
  });
});
