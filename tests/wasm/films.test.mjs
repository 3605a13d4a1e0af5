/* The films of all shipped scenes, and their ray counts, are those of the native program, with and without vectors. */

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ISAS, UNSUPPORTED, cuvetteOf, native, readScene, scenes } from './fixture.mjs';

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
