/* The speed of the WebAssembly modules next to the native program on one thread: rod.yaml, CPU seconds of a frame,
 * medians of runs that take turns. Markdown on standard output.
 * node tests/wasm/bench.mjs [REPETITIONS] */

import { Memory } from '../../src/wasm/api/memory.js';
import { Scene } from '../../src/wasm/api/scene.js';
import { ISAS, ROOT, moduleOf, readScene, runNative } from './fixture.mjs';

const repetitions = Number(process.argv[2] ?? 9);
const SCENE = 'rod';

function nativeOf(isa) {
  return () => runNative(`${ROOT}experiments/scenes/${SCENE}.yaml`, {}, { CUVETTE_ISA: isa }).cpu_s;
}

/* A frame by cuvette_engine_render, as the program renders it. */
async function moduleRun(isa) {
  const memory = new Memory(await moduleOf(isa));
  const scene = readScene({ Scene: { read: (...values) => Scene.read(memory, ...values) } }, SCENE, {});
  scene.set('render.threads', 1);
  const engine = memory.handle('cuvette_engine_create', 0);
  const run = () => {
    const before = process.cpuUsage();
    const frame = memory.handle('cuvette_engine_render', engine, scene.at, 0);
    const { user, system } = process.cpuUsage(before);
    memory.call('cuvette_frame_destroy', frame);
    return (user + system) / 1e6;
  };
  for (let i = 0; i < 3; i++) run(); /* until node has optimised the code */
  return run;
}

/* The instruction sets that this processor has. */
function nativeIsas() {
  return ['avx512', 'avx2', 'sse2'].filter((isa) => {
    try {
      return nativeOf(isa)() > 0;
    } catch {
      return false;
    }
  });
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

const rows = [];
for (const isa of nativeIsas()) rows.push({ name: `native, ${isa}`, run: nativeOf(isa), times: [] });
for (const isa of ISAS) rows.push({ name: `WebAssembly, ${isa}`, run: await moduleRun(isa), times: [] });
for (let i = 0; i < repetitions; i++) for (const row of rows) row.times.push(await row.run());

const natives = rows.filter(({ name }) => name.startsWith('native'));
const heads = natives.map(({ name }) => `speed relative to ${name.replace('native, ', '')}`);
console.log(`${SCENE}.yaml, one thread, ${repetitions} runs of each in turn; node ${process.version}\n`);
console.log(`| build | CPU time, median (s) | fastest (s) | ${heads.join(' | ')} |`);
console.log(`|---|---|---|${heads.map(() => '---|').join('')}`);
for (const { name, times } of rows) {
  const own = median(times);
  const ratios = natives.map((native) => (median(native.times) / own).toFixed(2));
  console.log(`| ${name} | ${own.toFixed(4)} | ${Math.min(...times).toFixed(4)} | ${ratios.join(' | ')} |`);
}
