// Escape takes back a drag: scene, view and undo are as before it, and the rest of the drag has no effect.
import { createHash } from 'node:crypto';

const size = { width: 1366, height: 768 };

/** Drags by CSS pixels, presses Escape when the drag has changed something, and goes on. */
async function cancelled(screen, { x, y }, [dx, dy], changed) {
  const { mouse, keyboard } = screen.page;
  await mouse.move(x, y);
  await mouse.down();
  await mouse.move(x + dx, y + dy, { steps: 5 });
  await changed();
  await keyboard.press('Escape');
  await mouse.move(x + 2 * dx, y + 2 * dy, { steps: 3 });
  await mouse.up();
  await screen.quiet();
}

const middle = async (node) => {
  const box = await node.boundingBox();
  return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
};

export const cases = {
  'a drag of a slider, the camera, an object, a light or the splitter': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, size);
    const { page } = screen;
    const state = async () => {
      const { undo, camera, saved } = await lab.get('/api/state');
      const params = (await lab.get('/api/scene')).params.map(({ path, value }) => `${path} ${value}`);
      return [undo, saved, createHash('sha256').update(JSON.stringify({ camera, params })).digest('hex')].join(' ');
    };
    const before = await state();
    const newer = async () => {
      const { generation } = await lab.get('/api/state');
      return () => screen.until((g) => window.lab.newestGeneration > g, generation);
    };
    const takesBack = async (what, from, by) => {
      await cancelled(screen, from, by, await newer());
      t.equal(await state(), before, `scene and view after Escape while dragging ${what}`);
    };
    await page.locator('[data-path="liquid.ior"] input[type=range]').scrollIntoViewIfNeeded();
    const slider = page.locator('[data-path="liquid.ior"] input[type=range]');
    const box = await slider.boundingBox();
    const thumb = await slider.evaluate((range) => range.value / range.max);
    const grip = { x: box.x + 8 + thumb * (box.width - 16), y: box.y + box.height / 2 };
    await takesBack('a slider', grip, [30, 0]);
    t.equal(await page.locator('[data-path="liquid.ior"] input[type=text]').inputValue(), '1.33', 'its number');
    const rod = await screen.place(415, 330);
    await takesBack('the camera', rod, [40, 10]);
    await screen.chooseTool('Object');
    await takesBack('an object', rod, [40, 10]);
    await screen.chooseTool('Light');
    await takesBack('a light', await middle(page.locator('.point-handle').first()), [-40, 10]);
    const width = () => page.locator('#side').evaluate((side) => side.clientWidth);
    const wide = await width();
    const splitter = await middle(page.locator('#splitter'));
    await cancelled(screen, splitter, [-60, 0], () =>
      screen.until((w) => document.querySelector('#side').clientWidth !== w, wide),
    );
    t.equal(await width(), wide, 'the width of the panels');
  },

  'a note is shown once, in one line on a telephone': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 390, height: 844, touch: true });
    const { page } = screen;
    const message = page.locator('.status-message');
    await message.getByText('A note on the scene').waitFor();
    t.more(60, (await message.boundingBox()).height, 'its height');
    await t.image(screen, 'note-phone');
    await page.getByRole('button', { name: 'Dismiss' }).click();
    await page.evaluate(() => sessionStorage.clear());
    await page.reload();
    await page.getByRole('button', { name: '1 note' }).waitFor({ state: 'attached' });
    t.equal(await message.isVisible(), false, 'the note after it was dismissed');
  },
};
