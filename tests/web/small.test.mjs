// Small windows, touch, large text and the projector mode: the image stays visible, targets are large enough, and axe
// reports no violation in these layouts.

const PANELS = ['Lessons', 'Parameters', 'Objects', 'Pixel', 'Bench', 'Compare', 'Slime', 'Machine', 'Studies'];
const WIDE = ['Lessons', 'Studies']; // panels that cover the image
const PHONE = { width: 390, height: 844, touch: true };
const SMALL = { width: 800, height: 600 };
const TARGET = 44;

/** The visible controls that are narrower or lower than a size; a label that belongs to a control counts with it. */
const smallTargets = (least) => {
  const found = [];
  const controls = 'a[href], button, input, select, textarea, summary, [role=tab], [role=slider], [role=separator]';
  for (const node of document.querySelectorAll(controls)) {
    if (!node.checkVisibility({ visibilityProperty: true, opacityProperty: true }) || node.closest('.skip')) continue;
    const label = node.closest('label');
    const target = label && label.contains(node) ? label : node;
    const { width, height } = target.getBoundingClientRect();
    if (width <= 1 || height <= 1) continue;
    if (width < least - 0.5 || height < least - 0.5)
      found.push(`${target.outerHTML.slice(0, 70)} ${Math.round(width)} x ${Math.round(height)}`);
  }
  return found;
};

/** The visible tabs that are not in the first row of their list, or nearer than a gap to its edges. */
const strayTabs = async () => {
  await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
  const gap = 4;
  return [...document.querySelectorAll('.tabs')].flatMap((list) => {
    const tabs = [...list.children].filter((tab) => tab.checkVisibility());
    const { left, right } = list.getBoundingClientRect();
    const top = tabs[0]?.offsetTop;
    return tabs
      .map((tab) => ({ tab, box: tab.getBoundingClientRect() }))
      .filter(({ tab, box }) => tab.offsetTop !== top || box.left < left + gap || box.right > right - gap)
      .map(({ tab, box }) => `${tab.innerText}: ${Math.round(box.left - left)}, ${Math.round(right - box.right)}`);
  });
};

/** How much of the image is visible, and whether the page itself scrolls. */
const imageShown = () => {
  const stage = document.getElementById('image').getBoundingClientRect();
  const { view } = window.lab;
  const [a, b] = [view.toScreen(0, 0), view.toScreen(view.width, view.height)];
  const across = Math.min(b.x, stage.width, innerWidth - stage.left) - Math.max(a.x, 0);
  const down = Math.min(b.y, stage.height, innerHeight - stage.top) - Math.max(a.y, 0);
  const middle = document.elementFromPoint(stage.left + stage.width / 2, stage.top + stage.height / 2);
  return {
    share: (across * down) / ((b.x - a.x) * (b.y - a.y)),
    width: b.x - a.x,
    covered: !document.getElementById('image').contains(middle),
    scrolls: document.scrollingElement.scrollHeight > innerHeight || scrollY !== 0,
  };
};

/** Fills the panels: a pixel's rays, a beam, a reference image. */
async function fill(screen) {
  const { page, lab } = screen;
  await lab.post('/api/objects', { kind: 'beam', name: 'laser' });
  await screen.settled((await lab.get('/api/state')).generation);
  await lab.post('/api/reference', {});
  await screen.showPanel('Pixel');
  await page.getByRole('spinbutton', { name: 'Pixel x' }).fill('330');
  await page.getByRole('spinbutton', { name: 'y', exact: true }).fill('420');
  await page.getByRole('spinbutton', { name: 'y', exact: true }).press('Enter');
  await page.getByRole('treegrid', { name: 'Rays of the pixel' }).getByRole('row').nth(3).waitFor();
  await screen.showPanel('Objects');
  await page.getByRole('tabpanel', { name: 'Objects' }).getByRole('button', { name: /^rod/ }).click();
}

async function eachPanel(t, screen, name, check) {
  for (const panel of PANELS) {
    await screen.showPanel(panel);
    await screen.quiet();
    await check(panel);
    await t.image(screen, `${name}-${panel}`);
  }
}

async function layout(t, name, options, key) {
  const lab = await t.lab('scenes/rod.yaml');
  const screen = await t.open(lab, options);
  if (key) await screen.page.keyboard.press(key);
  await fill(screen);
  await eachPanel(t, screen, name, async (panel) => {
    t.none(await screen.page.evaluate(strayTabs), `${panel}: tabs at the edge or in a second row`);
    if (!WIDE.includes(panel)) {
      await screen.page.evaluate(() => {
        const root = [...document.querySelectorAll('.panel')].find((each) => each.checkVisibility());
        [...root.querySelectorAll('button, input')]
          .filter((each) => each.checkVisibility())
          .at(-1)
          ?.focus();
      });
      const { share, width, covered, scrolls } = await screen.page.evaluate(imageShown);
      t.more(share, 0.99, `${panel}: visible share of the image while its last control is used`);
      t.more(width, 250, `${panel}: width of the image`);
      t.check(!covered && !scrolls, `${panel}: the image is covered, or the page scrolls`);
    }
    await t.axe(screen, `${name}, ${panel}`);
    if (options.touch) t.none(await screen.page.evaluate(smallTargets, TARGET), `${panel}: targets below 44 px`);
  });
  return screen;
}

export const cases = {
  'a phone, light': (t) => layout(t, 'phone-light', PHONE),
  'a phone, dark': (t) => layout(t, 'phone-dark', { ...PHONE, dark: true }),
  '800 x 600': (t) => layout(t, 'small-light', SMALL),
  '800 x 600, dark': (t) => layout(t, 'small-dark', { ...SMALL, dark: true }),
  'a tablet': (t) => layout(t, 'tablet', { width: 1180, height: 820, touch: true }),

  'large text': async (t) => {
    const screen = await layout(t, 'large', { width: 1366, height: 768 }, 't');
    await screen.page.reload();
    await screen.until(() => window.lab?.image);
    t.equal(await screen.page.evaluate(() => document.documentElement.dataset.text), 'large', 'remembered');
  },
  'the projector mode': (t) => layout(t, 'projector', { width: 1366, height: 768 }, 'p'),
  'the projector mode on a phone, dark': (t) => layout(t, 'projector-phone', { ...PHONE, dark: true }, 'p'),

  'tabs fit, also with words that are 40 % longer': async (t) => {
    const screen = await t.open(await t.lab('scenes/rod.yaml'), SMALL);
    const { page } = screen;
    const check = async (what) => {
      for (const [width, height] of [
        [1920, 1080],
        [1366, 768],
        [800, 600],
        [390, 844],
      ]) {
        await page.setViewportSize({ width, height });
        for (const group of await page.getByRole('tablist', { name: 'Panels' }).getByRole('tab').all()) {
          await group.click();
          t.none(await page.evaluate(strayTabs), `${width} x ${height}, ${what}, ${await group.innerText()}`);
        }
      }
    };
    await check('English');
    await page.evaluate(() => {
      for (const { firstChild } of document.querySelectorAll('.tab > span'))
        firstChild.data += firstChild.data.slice(0, Math.ceil(0.4 * firstChild.data.length));
    });
    await check('long words');
    await page.keyboard.press('p');
    await check('long words, projector');
  },

  'a lesson on a phone': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab, PHONE);
    await screen.page.getByRole('button', { name: /When water becomes a mirror/ }).click();
    await screen.button('Show the measurement').click();
    await screen.page.locator('.lesson-value').waitFor();
    await screen.settled();
    t.none(await screen.page.evaluate(smallTargets, TARGET), 'targets below 44 px');
    const rays = await screen.page.evaluate(() => {
      const [stage, value] = ['.section-stage', '.lesson-value'].map((name) =>
        document.querySelector(name).getBoundingClientRect(),
      );
      return { high: stage.height, apart: stage.bottom <= value.top, scrolls: scrollY !== 0 };
    });
    t.check(rays.high > 120 && rays.apart && !rays.scrolls, `the rays next to the lesson: ${JSON.stringify(rays)}`);
    await t.axe(screen, 'a lesson on a phone');
    await t.image(screen, 'phone-lesson');
  },

  'on a phone a note takes one line, and a view is undone by a touch': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, PHONE);
    const { page } = screen;
    await screen.settled();
    const back = page.getByRole('button', { name: 'Previous view' });
    const box = await back.boundingBox();
    t.check(box.x >= 0 && box.x + box.width <= PHONE.width, `the button is in sight: ${box.x}`);
    const eye = async () => (await lab.get('/api/state')).camera.eye;
    const before = await eye();
    await lab.post('/api/camera', { orbit: [30, 0], gesture: 'hand' });
    await screen.until(() => document.querySelector('.view-history:not(:disabled)'));
    t.check((await eye())[0] !== before[0], 'the view was turned');
    await back.tap();
    await screen.until((x) => Math.abs(window.lab.state.camera.eye[0] - x) < 1e-9, before[0]);
    t.near((await eye())[0], before[0], 1e-9, 'the view before');

    await lab.post('/api/set', { set: { 'render.depth': 2 } });
    const show = page.getByRole('button', { name: 'Show', exact: true });
    await show.waitFor();
    const cut = await page.locator('.status-words').evaluate((node) => ({
      across: node.scrollWidth - node.clientWidth,
      down: node.scrollHeight - node.clientHeight,
      left: node.getBoundingClientRect().left,
      right: innerWidth - node.getBoundingClientRect().right,
    }));
    t.check(cut.across <= 0 && cut.down <= 0 && cut.left >= 0 && cut.right >= 0, JSON.stringify(cut));
    await t.image(screen, 'phone-note');
    await show.tap();
    await page
      .getByRole('dialog')
      .getByRole('button', { name: /^Raise the depth/ })
      .first()
      .tap();
    await screen.until(() => window.lab.param('render.depth').value > 2);
  },

  'labels in the image are large for a projector': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1366, height: 768 });
    await screen.showPanel('Objects');
    await screen.page.getByRole('radio', { name: 'Light' }).check({ force: true });
    const size = () =>
      screen.page
        .locator('.point-name')
        .first()
        .evaluate((node) => parseFloat(getComputedStyle(node).fontSize));
    await screen.page.locator('.point-name').first().waitFor();
    const usual = await size();
    await screen.page.keyboard.press('p');
    await screen.until(() => document.documentElement.hasAttribute('data-projector'));
    t.more(await size(), 1.3 * usual, 'size of the names of lights');
    t.more(await size(), 17.9, 'in CSS pixels');
    await t.image(screen, 'projector-labels');
  },

  'the bottom sheet is moved by keys and by its handle': async (t) => {
    const screen = await t.open(await t.lab('scenes/rod.yaml'), PHONE);
    const { page } = screen;
    const height = () => page.evaluate(() => document.querySelector('.side').clientHeight);
    const before = await height();
    await page.getByRole('separator', { name: 'Height of the panels' }).focus();
    await page.keyboard.press('ArrowDown');
    t.near(await height(), before - 24, 1, 'height of the sheet after a key');
    const box = await page.getByRole('separator').boundingBox();
    await page.mouse.move(195, box.y + 20);
    await page.mouse.down();
    await page.mouse.move(195, box.y - 80, { steps: 4 });
    await page.mouse.up();
    t.near(await height(), before - 24 + 100, 2, 'height of the sheet after a drag');
  },
};
