// The displayed images: none is older than an earlier one, they keep coming while the scene changes, nearly every
// fetched one is drawn, and the last is the final image of the last value, exactly. Tabs share one event stream.
import { difference } from './screen.mjs';

/** Records every displayed image, once, and the requests for images, which the result returns. The event repeats for an
 * image that is already displayed. */
async function record(screen) {
  await screen.page.evaluate(() => {
    window.drawn = [];
    let { serial: last, exact: lastExact } = window.lab.image;
    window.lab.on('image', ({ serial, generation, pass, final, exact }) => {
      if (serial !== last || exact !== lastExact)
        window.drawn.push({ serial, generation, pass, final, exact, during: window.lab.dragging() });
      [last, lastExact] = [serial, exact];
    });
  });
  const asked = await screen.asked();
  return () => asked.filter((path) => path.startsWith('/api/image.'));
}

function checkOrder(t, drawn, what) {
  t.none(
    drawn
      .filter((frame, i) => i > 0 && (frame.serial < drawn[i - 1].serial || frame.generation < drawn[i - 1].generation))
      .map((frame) => JSON.stringify(frame)),
    `${what}: a frame older than the one before`,
  );
  t.check(drawn.at(-1)?.final, `${what}: the last frame is not final: ${JSON.stringify(drawn.at(-1))}`);
}

async function checkLast(t, screen, scene, what) {
  const { lab } = screen;
  const ior = await lab.value('liquid.ior');
  const { image } = await lab.get('/api/state');
  const account = JSON.parse(await lab.run('render', scene, '--json', '--set', `liquid.ior=${ior}`));
  t.equal(image.film_hash, account.film_hash, `${what}: the film of cuvette render for index ${ior}`);
  t.equal(
    difference(await screen.pixels(), await screen.served()),
    0,
    `${what}: share of pixels that differ from the laboratory's image`,
  );
}

export const cases = {
  '200 changes of a slider': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    const slider = await screen.paramSlider('liquid.ior');
    const fetchedNow = await record(screen);
    const before = (await lab.get('/api/state')).generation;
    await slider.focus();
    // 200 changes, and more where the images come slower than the keys.
    const seen = () => screen.page.evaluate(() => window.drawn.filter((frame) => frame.during).length);
    for (let i = 0; i < 200 || (i < 4000 && (i % 20 > 0 || (await seen()) < 5)); i++)
      await screen.page.keyboard.press(i % 40 < 20 ? 'ArrowRight' : 'ArrowLeft');
    await screen.page.keyboard.press('ArrowRight');
    await screen.settled(before + 1);
    const drawn = await screen.page.evaluate(() => window.drawn);
    const fetched = fetchedNow();
    checkOrder(t, drawn, 'keys');
    t.more(drawn.filter((frame) => frame.during).length, 4, 'keys: frames were drawn while the slider moved');
    t.more(drawn.length, 0.9 * fetched.length - 1, 'keys: nearly every fetched image was drawn');
    t.check(
      fetched.some((url) => url.includes('image.jpg')),
      'keys: images of the drag are JPEG',
    );
    t.equal(fetched.at(-1), '/api/image.png', 'keys: the last image is a PNG');
    await checkLast(t, screen, 'scenes/rod.yaml', 'keys');
  },

  'changes by other clients': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    await record(screen);
    let generation = 0;
    for (let i = 0; i < 200; i++)
      ({ generation } = await lab.post('/api/set', {
        set: { 'liquid.ior': 1 + (i + 1) / 400 },
        gesture: 'from outside',
      }));
    await screen.settled(generation);
    checkOrder(t, await screen.page.evaluate(() => window.drawn), 'requests');
    await checkLast(t, screen, 'scenes/rod.yaml', 'requests');
  },

  'a dragged camera is seen at every image': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1366, height: 768 });
    const fetchedNow = await record(screen);
    const { x, y } = await screen.place(400, 300);
    await screen.page.mouse.move(x, y);
    await screen.page.mouse.down();
    const before = (await lab.get('/api/state')).generation;
    for (let i = 0; i < 120; i++) await screen.page.mouse.move(x + i, y + (i % 20));
    await screen.page.mouse.up();
    await screen.settled(before + 1);
    const drawn = await screen.page.evaluate(() => window.drawn);
    const fetched = fetchedNow();
    checkOrder(t, drawn, 'drag');
    const sent = (await lab.get('/api/state')).generation - before;
    t.more(drawn.filter((frame) => frame.during).length, 2, 'drag: frames were drawn while the camera moved');
    t.more(drawn.length, 0.9 * fetched.length - 1, 'drag: nearly every fetched image was drawn');
    t.more(3 * drawn.length + 3, sent, 'drag: changes are sent at the pace of the images');
  },

  'ten tabs share one stream': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const tabs = [screen.page];
    for (let i = 1; i < 10; i++) {
      const page = await screen.context.newPage();
      await page.goto(lab.address);
      tabs.push(page);
    }
    const follows = async (page, generation) =>
      page.waitForFunction((g) => window.lab?.image?.final && window.lab.image.generation >= g, generation, {
        polling: 100, // a tab in the background may draw no frames
      });
    const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.4 } });
    for (const page of tabs) await follows(page, generation);
    // The tab with the stream is closed: another takes over.
    await tabs[0].close();
    screen.page = tabs[1];
    const next = await lab.post('/api/set', { set: { 'liquid.ior': 1.5 } });
    for (const page of tabs.slice(1)) await follows(page, next.generation);
    t.check(true, 'nine tabs follow after the first was closed');
  },

  'a state that comes after later events': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const page = await screen.context.newPage();
    let answered, release;
    const asked = new Promise((resolve) => (answered = resolve));
    const released = new Promise((resolve) => (release = resolve));
    await page.route('**/api/state', async (route) => {
      const response = await route.fetch();
      answered();
      await released;
      await route.fulfill({ response });
    });
    await page.goto(lab.address);
    await asked;
    const { generation } = await lab.post('/api/set', { set: { 'liquid.ior': 1.45 } });
    await screen.settled(generation);
    release();
    await page.waitForFunction((g) => window.lab.image?.final && window.lab.image.generation >= g, generation, {
      polling: 100,
    });
    t.equal(
      await page.evaluate(() => window.lab.state.generation),
      generation,
      'late state: the generation of the page',
    );
  },

  'the server stops and restarts': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    screen.expect(/net::ERR_|401|Failed to load resource|EventSource/);
    const banner = screen.page.locator('#banner');
    t.equal(await banner.isVisible(), false, 'the banner is visible while the server runs');
    await lab.stop();
    await banner.waitFor({ state: 'visible' });
    t.match(await banner.innerText(), /server/i, 'the banner names the server');
    await t.image(screen, 'lost');
    await lab.serve('scenes/rod.yaml');
    await screen.until(() => /address/i.test(document.querySelector('#banner').innerText));
    t.match(await banner.innerText(), /address/i, 'the banner names the newly printed address');
    await screen.load();
    t.equal(await banner.isVisible(), false, 'the banner is visible at the new address');
    t.check(
      await screen.page.evaluate(() => window.lab.image.final),
      'the final image is displayed at the new address',
    );
  },
};
