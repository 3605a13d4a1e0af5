// Changing the liquid's index with the page's slider moves the bar's edges in the image as predicted by Snell's law.
import { columnOfSlope, slopeOfEdge } from './optics.mjs';

const image = { width: 801, height: 301, fovDeg: 6 };
const bar = [-0.15, 0.25];
const disc = { distance: 9, radius: 1, depth: 0.5 };

/** The columns where the row at eye level changes from the sky's blue to the bar's red and back. */
function edges(shown) {
  const row = (shown.height - 1) / 2;
  const red = (x) => shown.data[(row * shown.width + x) * 4] > shown.data[(row * shown.width + x) * 4 + 2];
  const found = [];
  for (let x = 1; x < shown.width; x++) if (red(x) !== red(x - 1)) found.push(x);
  return found;
}

const predicted = (index) => bar.map((x) => columnOfSlope(slopeOfEdge(x, { ...disc, index }), image));

async function compare(t, screen, what) {
  await screen.settled();
  const index = await screen.lab.value('liquid.ior');
  const found = edges(await screen.pixels());
  const wanted = predicted(index);
  if (!t.equal(found.length, 2, `${what}, index ${index}: edges in the row at eye level`))
    return { index, found: [NaN, NaN] };
  for (const side of [0, 1])
    t.near(found[side], wanted[side], 1, `${what}, index ${index}: ${['left', 'right'][side]} edge, pixels`);
  return { index, found };
}

export const cases = {
  'typed indices': async (t) => {
    const lab = await t.lab('tests/edge.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    const seen = [await compare(t, screen, 'as opened')];
    for (const index of [1.1, 1.25, 1.45, 1.5]) {
      await screen.setNumber('liquid.ior', index);
      const now = await compare(t, screen, 'typed');
      t.equal(now.index, index, 'the scene has the typed value');
      for (const before of seen)
        t.more(
          Math.abs(now.found[1] - before.found[1]),
          4,
          `from index ${before.index} to ${index} the right edge moves, pixels`,
        );
      seen.push(now);
    }
  },

  'the slider, by keys and by the mouse': async (t) => {
    const lab = await t.lab('tests/edge.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    const first = await compare(t, screen, 'as opened');
    const slider = await screen.paramSlider('liquid.ior');
    await slider.focus();
    for (let i = 0; i < 10; i++) await screen.page.keyboard.press('ArrowRight');
    const keyed = await compare(t, screen, 'keys');
    t.more(keyed.index, first.index, 'keys raise the index');
    t.more(keyed.found[1] - first.found[1], 2, 'and the right edge moves, pixels');
    // From the current position of the handle, half of the distance to the left end.
    const box = await slider.boundingBox();
    const share = await slider.evaluate((input) => (input.value - input.min) / (input.max - input.min));
    const x = (part) => box.x + 8 + (box.width - 16) * part;
    await screen.page.mouse.move(x(share), box.y + box.height / 2);
    await screen.page.mouse.down();
    await screen.page.mouse.move(x(share / 2), box.y + box.height / 2, { steps: 25 });
    await screen.page.mouse.up();
    const dragged = await compare(t, screen, 'dragged');
    t.more(first.index, dragged.index, 'the mouse lowers the index');
    t.more(keyed.found[1] - dragged.found[1], 2, 'and the right edge moves back, pixels');
  },
};
