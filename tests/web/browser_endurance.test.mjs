// The laboratory without a server does not grow: a thousand images and a hundred grabs of the slime in one tab.
export const engine = 'browser';

/** The bytes of memory of the laboratory's module and of its tile workers' modules. */
async function memory(screen) {
  const sizes = await Promise.all(
    screen.page.workers().map((worker) =>
      /* global lab, tracer: of the worker's script */
      worker.evaluate(() => (lab ?? tracer).HEAPU8.length),
    ),
  );
  return { modules: sizes.length, bytes: sizes.reduce((sum, size) => sum + size, 0) };
}

export const cases = {
  'a thousand images': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const render = (first, end) =>
      screen.page.evaluate(
        async ([from, to]) => {
          for (let i = from; i < to; i++) {
            await window.lab.post('/api/set', { set: { 'liquid.ior': 1.3 + (i % 250) / 1000 } });
            await window.lab.engine.fetch('/api/image.jpg?wait=1&quick=1');
          }
        },
        [first, end],
      );
    await lab.post('/api/set', { set: { 'render.width': 120, 'render.height': 90 } });
    await render(0, 300);
    const before = await memory(screen);
    await render(300, 1000);
    const after = await memory(screen);
    t.check(before.modules >= 1, 'no module was found');
    t.equal(after.bytes, before.bytes, 'bytes of the modules after 1000 images, against those after 300');
  },

  'a hundred grabs of the slime': async (t) => {
    const lab = await t.lab('scenes/slime.yaml');
    const screen = await t.open(lab);
    const { full_width: width, full_height: height } = (await lab.get('/api/state')).image;
    const grab = async (count) => {
      for (let i = 0; i < count; i++) {
        await lab.post('/api/slime', { do: 'restart' }); /* pulled about, it would leave the image */
        await screen.page.waitForTimeout(400);
        const at = { x: width * 0.5, y: height * 0.5 };
        const { hand } = await lab.post('/api/slime/grab', at);
        await lab.post('/api/slime/move', { hand, x: at.x + width * 0.1, y: at.y - height * 0.1 });
        await screen.page.waitForTimeout(100);
        await lab.post('/api/slime/release', { hand });
      }
    };
    await grab(30);
    const before = await memory(screen);
    await grab(70);
    const after = await memory(screen);
    t.equal(after.bytes, before.bytes, 'bytes of the modules after 100 grabs, against those after 30');
    t.equal((await lab.get('/api/state')).slime.held, 0, 'masses that hands hold in the end');
  },
};
