// The dialog Appearance, decimal commas, the linter's buttons, drawings that follow the theme, what fits at
// 1366 px, and the difference map of the panel Compare.

const size = { width: 1366, height: 768 };

export const cases = {
  'theme, large text and projector by dialog and key, remembered': async (t) => {
    const screen = await t.open(await t.lab('scenes/rod.yaml'), size);
    const { page } = screen;
    const set = () =>
      page.evaluate(() => {
        const { theme, text, projector } = document.documentElement.dataset;
        return { theme, text, projector };
      });
    const height = () => page.evaluate(() => document.querySelector('.tab').getBoundingClientRect().height);
    const usual = await height();
    await screen.button('Appearance', true).click();
    await page.getByRole('checkbox', { name: /^Projector mode/ }).check();
    await page.getByRole('dialog').getByText('Dark theme', { exact: true }).click();
    await t.axe(screen, 'the dialog Appearance');
    await page.keyboard.press('Escape');
    t.equal(await set(), { theme: 'dark', text: 'large', projector: '' }, 'set by the dialog');
    t.more((await height()) / usual, 1.35, 'enlargement of a tab');
    await page.reload();
    await screen.until(() => window.lab?.image);
    t.equal(await set(), { theme: 'dark', text: 'large', projector: '' }, 'after a reload');
    await page.keyboard.press('p');
    await page.keyboard.press('t');
    t.equal(await set(), { theme: 'dark', text: 'large' }, 'after P and T');
    await page.keyboard.press('t');
    t.equal(await set(), { theme: 'dark' }, 'after T');
  },

  'rays are thick in the projector mode': async (t) => {
    const screen = await t.open(await t.lab('scenes/rod.yaml'), size);
    await screen.chooseTool('Inspect');
    await screen.clickPixel(330, 420);
    await screen.quiet();
    const widths = () =>
      screen.page.evaluate(() =>
        ['.layer-pixel .ray', '.layer-pixel .ray-halo'].map((name) =>
          parseFloat(getComputedStyle(document.querySelector(name)).strokeWidth),
        ),
      );
    const before = await widths();
    await screen.stage.focus();
    await screen.page.keyboard.press('p');
    const after = await widths();
    t.check(before[0] < 3 && after[0] > 4 && after[1] > after[0] + 4, `widths ${before} and ${after}`);
    const weak = await screen.page.evaluate(() =>
      Math.min(
        ...[...document.querySelectorAll('.layer-pixel .ray')].map((ray) =>
          parseFloat(getComputedStyle(ray).strokeWidth),
        ),
      ),
    );
    t.less(weak, after[0] / 2, 'the width of the weakest ray, such as a reflection of 4 %');
  },

  'a decimal comma in every kind of number field': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, size);
    const { page } = screen;
    await screen.setNumber('liquid.ior', '1,47');
    t.equal(await lab.value('liquid.ior'), 1.47, 'liquid.ior');
    await screen.showPanel('Parameters');
    const field = page.getByRole('spinbutton', { name: 'liquid ior, number', exact: true }).first();
    for (const [text, why] of [
      ['1,234.5', 'a thousands separator'],
      ['1.2.3', 'two points'],
      ['water', 'a word'],
    ]) {
      await field.fill(text);
      await field.press('Enter');
      await screen.quiet();
      t.equal(await lab.value('liquid.ior'), 1.47, `liquid.ior after ${why}`);
      const marked = await field.evaluate((node) => [
        node.value,
        node.ariaInvalid ?? node.getAttribute('aria-invalid'),
      ]);
      t.equal(marked, ['1.47', 'true'], `the field after ${why}`);
      t.check((await page.locator('.field-problem').textContent()).includes(text), `${why} is not reported`);
    }
    await field.fill('1,5');
    await field.press('ArrowUp');
    await screen.settled();
    t.more(await lab.value('liquid.ior'), 1.5, 'liquid.ior after an arrow key');

    await screen.button('Camera').click();
    const roll = page.getByRole('spinbutton', { name: 'Roll' });
    await roll.fill('2,5');
    await roll.press('Enter');
    await screen.quiet();
    t.equal(await lab.value('camera.roll_deg'), 2.5, 'camera.roll_deg');
    t.none(
      await page.evaluate(() =>
        [...document.querySelectorAll('input[type=number]')].map((node) => node.outerHTML.slice(0, 80)),
      ),
      'fields that drop a comma in some languages',
    );
  },

  'the depth note explains itself and raises the depth': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, size);
    const { page } = screen;
    await screen.button('Raise the depth').waitFor(); // next to the note in the status line
    await screen.button('1 note').click();
    await page.getByText(/render.beyond replaces their light/).waitFor();
    await page.getByText(/The default is 4/).waitFor();
    await t.axe(screen, 'the notes');
    await page
      .getByRole('dialog')
      .getByRole('button', { name: /^Raise the depth to \d+$/ })
      .click();
    await page.getByText('No notes.').waitFor();
    t.more(await lab.value('render.depth'), 4, 'render.depth');
    t.equal((await lab.get('/api/state')).undo, 'set render.depth', 'undo');
  },

  'a note on the image, not on the scene, is listed too': async (t) => {
    const screen = await t.open(await t.lab('tests/narrow.yaml'), size);
    await screen.button(/^\d+ notes?$/).click();
    const note = screen.page.getByRole('dialog').getByText(/narrower than a pixel/);
    await note.waitFor();
    t.equal(await note.count(), 1, 'notes on narrow light');
  },

  'a note on a caustic of few photons names its solid': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await lab.post('/api/set', { set: { 'render.depth': 8, 'render.caustics': 'photons', 'render.photons': 300 } });
    const screen = await t.open(lab, size);
    await screen.button(/^\d+ notes?$/).click();
    const note = screen.page.getByRole('dialog').getByText(/on matte surfaces rests on only/);
    await note.waitFor();
    const [, solid, photons] = (await note.innerText()).match(/that '(\w+)' throws on matte .* only (\d+) photons/);
    t.check(['vessel', 'liquid'].includes(solid), `the solid: ${solid}`);
    t.more(Number(photons), 0, 'photons');
  },

  'what fits at 1366 px': async (t) => {
    const screen = await t.open(await t.lab('scenes/rod.yaml'), size);
    const { page } = screen;
    await screen.chooseTool('Inspect');
    await screen.clickPixel(330, 420);
    await page.getByRole('treegrid', { name: 'Rays of the pixel' }).getByRole('row').nth(3).waitFor();
    const cut = await page.evaluate(() => {
      const frame = document.querySelector('.ray-table').getBoundingClientRect();
      return ['Ray', 'Media', 'Angles', 'R', 'T'].filter((name) => {
        const head = [...document.querySelectorAll('.ray-table thead th')].find((th) => th.textContent === name);
        return !head || head.getBoundingClientRect().right > frame.right + 0.5;
      });
    });
    t.none(cut, 'columns that are cut off');
  },

  'the larger drawing follows the theme': async (t) => {
    for (const dark of [false, true]) {
      const screen = await t.open(await t.lab('scenes/rod.yaml'), { ...size, dark });
      const { page } = screen;
      await screen.chooseTool('Inspect');
      await screen.clickPixel(330, 420);
      await screen.button('Larger drawing').click();
      const drawing = page.locator('.trace-drawing img[src]');
      await drawing.evaluate((node) => node.decode());
      const { readPng } = await import('./png.mjs');
      const { data } = readPng(await drawing.screenshot());
      t.check(dark ? data[12] < 80 : data[12] > 200, `the ground has ${data[12]} ${dark ? 'in dark' : 'in light'}`);
      await t.image(screen, `drawing-${dark ? 'dark' : 'light'}`);
    }
  },

  'a difference map never hides a newer image': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, size);
    const { page } = screen;
    await screen.showPanel('Compare');
    await screen.button('Pin as A').click();
    await screen.until(() => window.lab.state.reference);
    await page.getByText('Difference', { exact: true }).click();
    const map = () =>
      page.evaluate(() => document.querySelector('.layer-compare > image:nth-of-type(2)').style.display);
    await lab.post('/api/set', { set: { 'liquid.ior': 1.5 } });
    await screen.until(() => document.querySelector('.layer-compare > image:nth-of-type(2)').style.display === '');
    await page.evaluate(() => {
      window.hidden = [];
      window.lab.on('image', (image) => {
        const shown = document.querySelector('.layer-compare > image:nth-of-type(2)').style.display === '';
        if (shown && !image.final) window.hidden.push(image.serial);
      });
    });
    for (let i = 0; i < 20; i++)
      await page.evaluate((n) => window.lab.set({ 'liquid.ior': 1.2 + 0.01 * n }, 'drag'), i);
    await screen.settled();
    await screen.until(() => document.querySelector('.layer-compare > image:nth-of-type(2)').style.display === '');
    t.equal(await page.evaluate(() => window.hidden), [], 'images under an older map');
    t.equal(await map(), '', 'the map of the final image');
  },

  'motion is reduced when the system asks': async (t) => {
    const screen = await t.open(await t.lab('scenes/rod.yaml'), size);
    const moving = await screen.page.evaluate(
      () =>
        [...document.querySelectorAll('*')]
          .flatMap((node) => [null, '::before', '::after'].map((part) => getComputedStyle(node, part)))
          .filter((style) => style.transitionDuration !== '0s' || style.animationName !== 'none').length,
    );
    t.equal(moving, 0, 'elements that move');
  },
};
