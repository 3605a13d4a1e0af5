/* The film of a laboratory whose tiles other workers trace is that of the native program: one worker, and several. The
 * workers are modules of this thread, which hand each other the bytes that workers of a browser send as messages. */

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ISAS, UNSUPPORTED, moduleOf, native, scenes, settingsOf, textOf, filesOf } from './fixture.mjs';

const FOLDER = '/laboratory';
const encoder = new TextEncoder();

function withBytes(module, bytes, use) {
  const address = module._malloc(bytes.length + 1);
  module.HEAPU8.set(bytes, address);
  module.HEAPU8[address + bytes.length] = 0;
  try {
    return use(address, bytes.length);
  } finally {
    module._free(address);
  }
}
const withText = (module, text, use) => withBytes(module, encoder.encode(text), use);

/* Traces an order; the bytes of the answer. */
function traced(tracer, order) {
  return withBytes(tracer, new Uint8Array(4), (size) => {
    const answer = withBytes(tracer, order, (address, length) => tracer._wasm_tiles_trace(address, length, size));
    const length = new DataView(tracer.HEAPU8.buffer).getUint32(size, true);
    return tracer.HEAPU8.slice(answer, answer + length);
  });
}

class Laboratory {
  static async open(isa, workers, name) {
    const lab = new Laboratory();
    lab.replies = [];
    lab.sent = [];
    lab.orders = 0;
    lab.tracers = [];
    for (let i = 0; i < workers; i++) lab.tracers.push(await moduleOf(isa));
    lab.module = await moduleOf(isa, {
      reply: (id, status, headers, bytes) => lab.replies.push({ id, status, bytes }),
      event() {},
      send: (worker, kind, bytes) => lab.sent.push({ worker, kind, bytes }),
    });
    lab.#start(name, workers);
    return lab;
  }

  #start(name, workers) {
    const { module } = this;
    const text = textOf(name);
    module.FS.mkdir(FOLDER);
    module.FS.chdir(FOLDER);
    const files = { ...filesOf(text), [`scenes/${name}.yaml`]: encoder.encode(text) };
    for (const [path, bytes] of Object.entries(files)) {
      const folder = `${FOLDER}/${path.slice(0, path.lastIndexOf('/'))}`;
      if (!module.FS.analyzePath(folder).exists) module.FS.mkdir(folder);
      module.FS.writeFile(`${FOLDER}/${path}`, bytes);
    }
    const code = withText(module, FOLDER, (folder) =>
      withText(module, `${FOLDER}/scenes/${name}.yaml`, (scene) => module._wasm_lab_start(folder, scene, workers)),
    );
    assert.equal(code, 0, module.UTF8ToString(module._wasm_why()));
    const set = settingsOf(name);
    if (Object.keys(set).length) this.ask('POST', '/api/set', { set });
  }

  /* What the workers have to do, and the laboratory's next turn. */
  turn() {
    for (const { worker, kind, bytes } of this.sent.splice(0)) {
      const tracer = this.tracers[worker];
      if (kind === 0) {
        assert.equal(
          withBytes(tracer, bytes, (address, size) => tracer._wasm_tiles_scene(address, size)),
          0,
        );
      } else {
        this.orders++;
        withBytes(this.module, traced(tracer, bytes), (at, size) => this.module._wasm_lab_traced(worker, at, size));
      }
    }
    return this.module._wasm_lab_turn();
  }

  ask(method, path, body) {
    const { module } = this;
    const text = body ? JSON.stringify(body) : '';
    withText(module, method, (m) =>
      withText(module, path, (p) => withText(module, text, (b, size) => module._wasm_lab_request(1, m, p, b, size))),
    );
    for (let i = 0; i < 1e6 && !this.replies.length; i++) this.turn();
    const { status, bytes } = this.replies.shift();
    const reply = JSON.parse(new TextDecoder().decode(bytes));
    assert.ok(status < 300, `${method} ${path}: ${status} ${JSON.stringify(reply)}`);
    return reply;
  }

  /* The hash of the final image. */
  hash() {
    const until = Date.now() + 120000;
    for (;;) {
      for (let i = 0; i < 20; i++) this.turn();
      const { image } = this.ask('GET', '/api/state');
      if (image?.film_hash) return image.film_hash;
      assert.ok(Date.now() < until, 'no final image');
    }
  }
}

for (const isa of ISAS)
  for (const workers of [1, 3])
    for (const name of process.env.ONLY ? [process.env.ONLY] : isa === 'plain' ? ['rod', 'caustic'] : scenes)
      test(`${isa}, ${workers} tile workers: the film of ${name}`, { skip: UNSUPPORTED[name] }, async () => {
        const lab = await Laboratory.open(isa, workers, name);
        assert.equal(lab.hash(), native(name).hash);
      });
