// A ball of slime falls, is grabbed at its top, lifted until it is stretched, and released: it recovers its shape. The
// green pixels of the image are the body.

const LIFT = 60;
const IN = 12;
/** The required stretch while it is held; it hangs still, so the value is stable. */
const DRAWN_OUT = 1.2;

function silhouette({ width, height, data }) {
  let [count, left, right, top, bottom] = [0, width, -1, height, -1];
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++) {
      const i = (y * width + x) * 4;
      if (data[i + 1] < 1.3 * data[i] || data[i + 1] < 1.3 * data[i + 2]) continue;
      count++;
      [left, right, top, bottom] = [Math.min(left, x), Math.max(right, x), Math.min(top, y), Math.max(bottom, y)];
    }
  return { count, left, top, wide: right - left, high: bottom - top, middle: (left + right) / 2 };
}

const atRest = (screen) =>
  screen.until(() => window.lab.slime?.resting && window.lab.slime.held === 0 && window.lab.image.final);
const held = (screen, yes) => screen.until((wanted) => window.lab.slime.held > 0 === wanted, yes);
const nextImage = (screen) =>
  screen.page.evaluate(
    () =>
      new Promise((drawn) => {
        const end = window.lab.on('image', () => {
          end();
          drawn();
        });
      }),
  );

async function fallen(t) {
  const lab = await t.lab('tests/slime.yaml');
  const screen = await t.open(lab, { width: 1920, height: 1080 });
  await screen.actualSize();
  await screen.showPanel('Slime');
  await screen.button('Play').click();
  await atRest(screen);
  await screen.chooseTool('Grab');
  return { lab, screen, rest: silhouette(await screen.pixels()) };
}

/** Waits until the held body is still: its top and height change by at most STILL pixels over FRAMES frames. */
async function untilStill(screen) {
  const [STILL, FRAMES] = [4, 8];
  let [reference, unchanged] = [silhouette(await screen.pixels()), 0];
  while (unchanged < FRAMES) {
    await nextImage(screen);
    const now = silhouette(await screen.pixels());
    const moved = Math.max(Math.abs(now.top - reference.top), Math.abs(now.high - reference.high)) > STILL;
    [reference, unchanged] = moved ? [now, 0] : [reference, unchanged + 1];
  }
  return reference;
}

async function drawnOut(t, screen, rest) {
  const now = await untilStill(screen);
  t.more(now.high, DRAWN_OUT * rest.high, 'the height while it is held, pixels');
  t.more(
    rest.wide / rest.high,
    (1.1 * now.wide) / now.high,
    'the ratio of width to height at rest, above 1.1 times that when lifted',
  );
  t.near(now.top, rest.top - LIFT, IN, 'the top follows the hand, pixels');
}

async function checkBack(t, lab, screen, rest) {
  await held(screen, false);
  await atRest(screen);
  const now = silhouette(await screen.pixels());
  // It may have rolled nearer or farther and onto another side, which affects its shape; the tolerance is below half of
  // the effect of lifting.
  t.near(now.wide / now.high, rest.wide / rest.high, 0.1, 'the ratio of width to height after the release');
  t.near(
    now.count / (now.wide * now.high),
    rest.count / (rest.wide * rest.high),
    0.03,
    'the filled share of its bounding box after the release',
  );
  const { slime } = await lab.get('/api/state');
  t.near(slime.volume / slime.volume_at_rest, 1, 0.03, 'its volume relative to that at rest');
  t.equal(slime.trouble, null, 'the error of the slime');
}

export const cases = {
  'lifted by the mouse': async (t) => {
    const { lab, screen, rest } = await fallen(t);
    t.more(rest.count, 10000, 'the body is in the image, pixels');
    const [a, b] = [
      await screen.place(rest.middle, rest.top + IN),
      await screen.place(rest.middle, rest.top + IN - LIFT),
    ];
    await screen.page.mouse.move(a.x, a.y);
    await screen.page.mouse.down();
    await held(screen, true);
    await screen.page.mouse.move(b.x, b.y, { steps: 10 });
    await drawnOut(t, screen, rest);
    await screen.page.mouse.up();
    await checkBack(t, lab, screen, rest);
  },

  'lifted by keys': async (t) => {
    const { lab, screen, rest } = await fallen(t);
    await screen.stage.focus();
    // The cross starts in the centre of the image; a key moves it by a fiftieth of the image width.
    const { width, height } = await screen.page.evaluate(() => ({
      width: window.lab.view.width,
      height: window.lab.view.height,
    }));
    const up = async (pixels) => {
      for (let i = 0; i < Math.round((pixels * 50) / width); i++) await screen.page.keyboard.press('ArrowUp');
    };
    await up(height / 2 - rest.top - IN);
    await screen.page.keyboard.press('Enter');
    await held(screen, true);
    await screen.page.getByText('Slime grabbed').first().waitFor();
    await up(LIFT);
    await drawnOut(t, screen, rest);
    await screen.page.keyboard.press('Enter');
    await checkBack(t, lab, screen, rest);
  },

  'a grab by keys is reported when it has succeeded': async (t) => {
    const lab = await t.lab('tests/slime.yaml');
    const screen = await t.open(lab);
    await screen.chooseTool('Grab');
    await screen.page.evaluate(() => {
      const { lab } = window;
      const say = lab.say;
      window.said = [];
      lab.say = (words, ...others) => {
        window.said.push(words);
        return say(words, ...others);
      };
    });
    screen.expect(/404 .*api\/slime\/grab/);
    await screen.stage.focus();
    for (let i = 0; i < 50; i++) await screen.page.keyboard.press('ArrowUp');
    await screen.page.keyboard.press('Enter');
    await screen.until(() => window.said.includes('No slime at that point'));
    t.equal((await screen.page.evaluate(() => window.said)).length, 1, 'messages after a grab next to the slime');
  },

  'a paused slime keeps its shape, and off restores the scene': async (t) => {
    const lab = await t.lab('tests/slime.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Slime');
    await screen.button('Play').click();
    await screen.until(() => window.lab.slime.time_s > 0.2);
    await screen.button('Pause').click();
    await screen.until(() => !window.lab.slime.playing && window.lab.image.final);
    const { slime, image } = await lab.get('/api/state');
    const own = JSON.parse(await lab.run('render', 'tests/slime.yaml', '--json')).film_hash;
    t.check(image.film_hash !== own, 'the image shows the simulated slime, not that of the scene');
    t.equal((await lab.get('/api/state')).slime.time_s, slime.time_s, 'its time while paused');
    await screen.button('Off').click();
    await screen.until((hash) => window.lab.image.film_hash === hash, own);
    t.equal((await lab.get('/api/state')).slime.on, false, 'the slime is on after Off');
  },

  'a scene without a slime has no tool Grab': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Slime');
    await screen.page.getByText('This scene has no slime').waitFor();
    const tools = screen.page.getByRole('radiogroup', { name: 'Pointer tool' });
    t.equal(await tools.getByText('Grab').isVisible(), false, 'the tool Grab is visible without a slime');
    const { generation } = await lab.get('/api/state');
    await screen.button('Add a slime').click();
    await screen.until((g) => window.lab.newestGeneration > g, generation);
    await screen.settled(generation + 1);
    await screen.button('Play').waitFor();
    t.check(await tools.getByText('Grab').isVisible(), 'the tool Grab is visible after a slime was added');
  },
};
