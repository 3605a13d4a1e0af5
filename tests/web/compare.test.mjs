// Comparison with a pinned reference image: with a changed scene the wipe shows A to the left and B to the right, pixel
// by pixel.
import { readPng } from './png.mjs';
import { difference } from './screen.mjs';

/** The pixels to each side of the edge that its line and handle may cover. */
const EDGE = 24;

async function pinAndChange(t) {
  const lab = await t.lab('scenes/rod.yaml');
  const screen = await t.open(lab, { width: 1920, height: 1080 });
  await screen.actualSize();
  await screen.showPanel('Compare');
  await screen.button('Pin as A').click();
  await screen.until(() => window.lab.state.reference);
  const { generation } = await lab.post('/api/set', {
    set: { 'plastic.color': [0.1, 0.7, 0.2], 'tiles.color': [0.9, 0.8, 0.3] },
  });
  await screen.settled(generation);
  await screen.quiet();
  return { lab, screen, a: readPng((await lab.ask('GET', '/api/reference.png')).bytes), b: await screen.served() };
}

export const cases = {
  'the wipe': async (t) => {
    const { screen, a, b } = await pinAndChange(t);
    t.more(difference(a, b), 0.1, 'share of pixels in which A and B differ');
    const share = screen.page.getByRole('slider', { name: 'Fraction of A' });
    for (const percent of [0, 50, 100]) {
      await share.focus();
      await screen.page.keyboard.press(percent === 100 ? 'End' : 'Home');
      if (percent === 50) for (let i = 0; i < 50; i++) await screen.page.keyboard.press('ArrowRight');
      await screen.page.mouse.move(1, 1);
      await screen.quiet();
      const seen = await screen.displayed();
      const edge = (seen.width * percent) / 100;
      // The letters A and B are in the upper corners.
      const left = (x, y) => x < edge - EDGE && y > 40;
      const right = (x, y) => x >= edge + EDGE && y > 40;
      if (percent > 0)
        t.equal(difference(seen, a, left), 0, `${percent} %: share of pixels to the left that differ from A`);
      if (percent < 100)
        t.equal(difference(seen, b, right), 0, `${percent} %: share of pixels to the right that differ from B`);
    }
  },

  'the handle of the wipe in the image': async (t) => {
    const { screen, a, b } = await pinAndChange(t);
    const handle = screen.page.getByRole('slider', { name: 'Fraction of the reference image' });
    const box = await handle.boundingBox();
    const [from, to] = [{ x: box.x + box.width / 2, y: box.y + box.height / 2 }, await screen.place(200, 300)];
    await screen.page.mouse.move(from.x, from.y);
    await screen.page.mouse.down();
    await screen.page.mouse.move(to.x, from.y, { steps: 10 });
    await screen.page.mouse.up();
    await screen.page.mouse.move(1, 1);
    await screen.quiet();
    t.near(Number(await handle.getAttribute('aria-valuenow')), 25, 1, 'the share of A after the drag, percent');
    const seen = await screen.displayed();
    t.equal(
      difference(seen, a, (x, y) => x < 200 - EDGE && y > 40),
      0,
      'share of pixels to the left that differ from A',
    );
    t.equal(
      difference(seen, b, (x, y) => x > 200 + EDGE && y > 40),
      0,
      'share of pixels to the right that differ from B',
    );
  },

  'the difference map': async (t) => {
    const { lab, screen, b } = await pinAndChange(t);
    const map = readPng((await lab.ask('GET', '/api/compare.png')).bytes);
    await screen.page.getByRole('radio', { name: 'Difference' }).locator('xpath=ancestor::label').click();
    await screen.page.locator('#image').getByText('Difference from A', { exact: true }).waitFor();
    await screen.page.mouse.move(1, 1);
    await screen.quiet();
    t.near(
      difference(await screen.displayed(), map, (x, y) => y > 40),
      0,
      0.001,
      'share of pixels that differ from the map',
    );
    await t.axe(screen, 'the difference map');
    await screen.button('Close: Difference from A').click();
    await screen.page.mouse.move(1, 1);
    await screen.quiet();
    t.equal(
      difference(await screen.displayed(), b, (x, y) => y > 40),
      0,
      'after closing the map: share of pixels that differ from B',
    );
  },

  'the metrics of the comparison': async (t) => {
    const { lab, screen } = await pinAndChange(t);
    const { a, b, changed, comparison } = await lab.get('/api/compare?wait=1');
    const panel = screen.page.getByRole('tabpanel', { name: 'Compare' });
    // The metrics of A against A may be displayed until those of the new image arrive.
    await panel.getByText(b.film_hash).waitFor();
    const text = await panel.innerText();
    for (const value of [a.film_hash, b.film_hash, 'plastic.color', 'tiles.color'])
      t.check(text.includes(value), `the panel does not show ${value}`);
    t.equal(changed.map((row) => row.path).sort(), ['plastic.color', 'tiles.color'], 'the changed parameters');
    const psnr = Number(text.match(/PSNR\s+([\d.]+)/)?.[1]);
    t.near(psnr, comparison.psnr_db, 0.01, 'PSNR, dB');
    await screen.button('Clear A').click();
    await screen.until(() => !window.lab.state.reference);
    await screen.quiet();
    t.equal(
      difference(await screen.displayed(), await screen.served(), (x, y) => y > 40),
      0,
      'without A: share of pixels that differ from B',
    );
  },
};
