// The lamp is dragged in the image, and the ball's shadow is where the closed form predicts it.
import { camera, inShadow } from './optics.mjs';

const eye = [0, 6, -5];
const size = { width: 640, height: 480 };
const view = camera({ position: eye, target: [0, 0, 0], fovDeg: 45, ...size });
const ball = { centre: [0, 1, 0], radius: 0.3 };

/** Centre and number of the pixels that satisfy a condition. */
function region(inside) {
  let [n, sx, sy] = [0, 0, 0];
  for (let y = 0; y < size.height; y++)
    for (let x = 0; x < size.width; x++) if (inside(x, y)) [n, sx, sy] = [n + 1, sx + x, sy + y];
  return { n, x: sx / n, y: sy / n };
}

async function compare(t, screen, what) {
  await screen.settled();
  const lamp = await screen.lab.value('lamp.position');
  const shown = await screen.pixels();
  const at = (x, y, c) => shown.data[(y * size.width + x) * 4 + c];
  const dark = (x, y) => at(x, y, 0) < 100 && at(x, y, 2) < 100;
  const shade = (x, y) => inShadow(x + 0.5, y + 0.5, { eye, view, ball, lamp });
  const [found, expected] = [region(dark), region(shade)];
  t.more(expected.n, 300, `${what}: pixels of the expected shadow`);
  t.near(found.x, expected.x, 1, `${what}, lamp at ${lamp}: the centre of the shadow, x`);
  t.near(found.y, expected.y, 1, `${what}, lamp at ${lamp}: the centre of the shadow, y`);
  const wrong = region((x, y) => dark(x, y) !== shade(x, y)).n;
  t.check(wrong <= expected.n / 50, `${what}: ${wrong} of ${expected.n} pixels differ from the closed form`);
  return { lamp, ...found };
}

export const cases = {
  'the lamp is dragged': async (t) => {
    const lab = await t.lab('tests/shadow.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    const before = await compare(t, screen, 'as opened');
    await screen.chooseTool('Light');
    const handle = view.project(before.lamp);
    await screen.drag(handle, { x: handle.x - 60, y: handle.y + 40 });
    const after = await compare(t, screen, 'dragged');
    t.more(Math.hypot(...after.lamp.map((v, i) => v - before.lamp[i])), 0.2, 'the lamp has moved');
    t.more(Math.hypot(after.x - before.x, after.y - before.y), 10, 'the shadow has moved, pixels');
    const there = view.project(after.lamp);
    t.near(there.x, handle.x - 60, 2, 'the lamp is where the pointer was released, x');
    t.near(there.y, handle.y + 40, 2, 'the lamp is where the pointer was released, y');
  },
};
