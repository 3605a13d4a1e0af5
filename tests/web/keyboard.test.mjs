// The page without a mouse: focus order and keys of the image, the tools, the parameters and the panels.

const LONGEST_WAY = 120;

/** Presses Tab until an element that matches has the focus. */
async function tabTo(t, screen, selector) {
  for (let i = 0; i < LONGEST_WAY; i++) {
    await screen.page.keyboard.press('Tab');
    if (await screen.page.evaluate((s) => document.activeElement.matches(s), selector)) return true;
  }
  return t.check(false, `Tab does not reach ${selector}`);
}

/** Checks that the focus is visible. */
async function checkFocusShows(t, screen, what) {
  const shown = await screen.page.evaluate(() => {
    const visible = (node) => {
      const { outlineStyle, outlineWidth, boxShadow } = getComputedStyle(node);
      return (outlineStyle !== 'none' && parseFloat(outlineWidth) >= 1) || boxShadow !== 'none';
    };
    const node = document.activeElement;
    return visible(node) || Boolean(node.closest('label') && visible(node.closest('label')));
  });
  t.check(shown, `${what}: the focus is not visible`);
}

export const cases = {
  'tabbing through the page': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const names = [];
    const nameless = [];
    for (let i = 0; i < LONGEST_WAY; i++) {
      await screen.page.keyboard.press('Tab');
      const at = await screen.page.evaluate(() => {
        const node = document.activeElement;
        if (node === document.body) return null;
        const labels = [...(node.labels ?? [])].map((label) => label.innerText).join(' ');
        const name =
          node.getAttribute('aria-label') ||
          labels ||
          document.getElementById(node.getAttribute('aria-labelledby'))?.innerText ||
          node.innerText ||
          node.title;
        return { name: (name || '').trim(), what: node.outerHTML.slice(0, 90) };
      });
      if (!at) break;
      names.push(at.name);
      if (!at.name) nameless.push(at.what);
    }
    t.more(names.length, 15, 'elements that Tab reaches');
    t.none(nameless, 'elements without an accessible name');
  },

  'the image': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await tabTo(t, screen, '#image');
    await checkFocusShows(t, screen, 'the image');
    const eye = async () => (await lab.get('/api/state')).camera.eye;
    for (const key of ['ArrowLeft', 'ArrowUp', 'w', 'd', 'PageUp']) {
      const { generation, camera } = await lab.get('/api/state');
      await screen.page.keyboard.press(key);
      await screen.until((g) => window.lab.state.generation > g, generation);
      const moved = Math.hypot(...(await eye()).map((v, i) => v - camera.eye[i]));
      t.more(moved, 1e-3, `${key} moves the camera`);
    }
    await screen.settled();
    const scale = () => screen.page.evaluate(() => window.lab.view.scale);
    const before = await scale();
    await screen.page.keyboard.press('+');
    t.more(await scale(), before, '+ zooms in');
    await screen.page.keyboard.press('0');
    t.near(await scale(), before, 1e-6, '0 fits the image into the view');
  },

  'the tools': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await tabTo(t, screen, '[role=radiogroup] input[type=radio]');
    await checkFocusShows(t, screen, 'the tools');
    const chosen = () => screen.page.evaluate(() => window.lab.view.chosen);
    const first = await chosen();
    const seen = new Set([first]);
    const all = await screen.page.getByRole('radiogroup', { name: 'Pointer tool' }).getByRole('radio').count();
    for (let i = 1; i < all; i++) {
      await screen.page.keyboard.press('ArrowRight');
      seen.add(await chosen());
    }
    t.more(all, 1, 'tools');
    t.equal(seen.size, all, 'tools that the arrow keys select');
  },

  'a light': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.chooseTool('Light');
    await screen.page.locator('#head').click({ position: { x: 5, y: 5 } });
    await tabTo(t, screen, '.point-handle');
    await checkFocusShows(t, screen, 'the light');
    const before = await lab.value('lamp.position');
    await screen.page.keyboard.press('ArrowLeft');
    await screen.until((x) => window.lab.param('lamp.position').value[0] < x, before[0]);
    t.more(before[0], (await lab.value('lamp.position'))[0], 'an arrow key moves the lamp to the left');
  },

  'a parameter': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Parameters');
    await tabTo(t, screen, '.param[data-path="liquid.ior"] input[type=range]');
    await checkFocusShows(t, screen, 'the slider');
    await screen.page.keyboard.press('ArrowRight');
    await screen.until(() => window.lab.param('liquid.ior').value > 1.33);
    t.more(await lab.value('liquid.ior'), 1.33, 'an arrow key increases the index');
    await tabTo(t, screen, '.param[data-path="liquid.ior"] input[role=spinbutton]');
    await screen.page.keyboard.type('1.4');
    await screen.page.keyboard.press('Enter');
    await screen.until(() => window.lab.param('liquid.ior').value === 1.4);
    t.equal(await lab.value('liquid.ior'), 1.4, 'the value typed into the number field');
    await tabTo(t, screen, '.param[data-path="liquid.ior"] button');
    await screen.page.keyboard.press('Enter');
    await screen.until(() => window.lab.param('liquid.ior').value === 1.33);
    t.equal(await lab.value('liquid.ior'), 1.33, 'the value after the reset button');
  },

  'the panels': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await tabTo(t, screen, '[role=tab]');
    await checkFocusShows(t, screen, 'the tabs');
    await screen.page.keyboard.press('Home');
    const { page } = screen;
    const groups = page.getByRole('tablist', { name: 'Panels' }).getByRole('tab');
    const focus = () => page.evaluate(() => document.activeElement.innerText);
    const shown = async () => {
      const frames = await page.getByRole('tabpanel').all();
      const id = await frames.at(-1).getAttribute('aria-labelledby');
      return page.locator(`#${id}`).innerText();
    };
    const names = [];
    for (const group of await groups.allInnerTexts()) {
      t.equal(await focus(), group, 'the tab that an arrow key comes to');
      const inner = page.getByRole('tablist', { name: group, exact: true }).getByRole('tab');
      const titles = await inner.allInnerTexts();
      if (titles.length) await page.keyboard.press('Tab');
      if (titles.length) await page.keyboard.press('Home');
      for (const title of titles) {
        t.equal([await focus(), await shown()], [title, title], `the panel of the tab in ${group}`);
        await page.keyboard.press('ArrowRight');
      }
      if (titles.length) await page.keyboard.press('Shift+Tab');
      names.push(...(titles.length ? titles : [await shown()]));
      await page.keyboard.press('ArrowRight');
    }
    t.equal(names, await screen.panelNames(), 'panels that keys show');
    t.equal(await focus(), await groups.first().innerText(), 'the tab after the last one');
  },

  'the shortcuts are listed': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.page.keyboard.press('?');
    const dialog = screen.page.getByRole('dialog', { name: 'Keyboard shortcuts' });
    await dialog.waitFor();
    await t.axe(screen, 'the dialog of keys');
    await t.image(screen, 'keys');
    await screen.page.keyboard.press('Escape');
    await dialog.waitFor({ state: 'hidden' });
    t.equal(await dialog.count(), 0, 'Escape closes the dialog');
  },
};
