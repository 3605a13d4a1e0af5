// The order of displayed images: none is older than an earlier one or than a known change, and the last is the final
// image of the last value.
import { difference } from './screen.mjs';

/** Records every pass that is displayed, once, with the newest known generation at that time. The event repeats for
 * an image that is already displayed. */
const record = (screen) =>
  screen.page.evaluate(() => {
    window.drawn = [];
    let { serial: last } = window.lab.picture;
    window.lab.on('picture', ({ serial, generation, pass, final }) => {
      if (serial !== last)
        window.drawn.push({ serial, generation, pass, final, expected: window.lab.newestGeneration });
      last = serial;
    });
  });

function checkOrder(t, drawn, what) {
  t.none(
    drawn
      .filter((frame, i) => i > 0 && (frame.serial < drawn[i - 1].serial || frame.generation < drawn[i - 1].generation))
      .map((frame) => JSON.stringify(frame)),
    `${what}: a frame older than the one before`,
  );
  t.none(
    drawn.filter((frame) => frame.generation < frame.expected).map((frame) => JSON.stringify(frame)),
    `${what}: a frame older than the known generation`,
  );
  t.check(drawn.at(-1)?.final, `${what}: the last frame is not final: ${JSON.stringify(drawn.at(-1))}`);
}

async function checkLast(t, screen, scene, what) {
  const { lab } = screen;
  const ior = await lab.value('liquid.ior');
  const { picture } = await lab.get('/api/state');
  const account = JSON.parse(await lab.run('render', scene, '--json', '--set', `liquid.ior=${ior}`));
  t.equal(picture.film_hash, account.film_hash, `${what}: the film of cuvette render for index ${ior}`);
  t.equal(
    difference(await screen.pixels(), await screen.served()),
    0,
    `${what}: share of pixels that differ from the server's image`,
  );
}

export const cases = {
  '200 changes of a slider': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { width: 1920, height: 1080 });
    await screen.actualSize();
    const slider = await screen.paramSlider('liquid.ior');
    await record(screen);
    const before = (await lab.get('/api/state')).generation;
    await slider.focus();
    for (let i = 0; i < 200; i++) await screen.page.keyboard.press(i % 40 < 20 ? 'ArrowRight' : 'ArrowLeft');
    await screen.page.keyboard.press('ArrowRight');
    await screen.settled(before + 1);
    const drawn = await screen.page.evaluate(() => window.drawn);
    checkOrder(t, drawn, 'keys');
    t.more(drawn.length, 1, 'keys: frames were drawn');
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

  'the server stops and restarts': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    screen.expect(/net::ERR_|401|Failed to load resource|EventSource/);
    const banner = screen.page.locator('#banner');
    t.equal(await banner.isVisible(), false, 'the banner is visible while the server runs');
    await lab.stop();
    await banner.waitFor({ state: 'visible' });
    t.match(await banner.innerText(), /server/i, 'the banner names the server');
    await t.picture(screen, 'lost');
    await lab.serve('scenes/rod.yaml');
    await screen.until(() => /address/i.test(document.querySelector('#banner').innerText));
    t.match(await banner.innerText(), /address/i, 'the banner names the newly printed address');
    await screen.load();
    t.equal(await banner.isVisible(), false, 'the banner is visible at the new address');
    t.check(
      await screen.page.evaluate(() => window.lab.picture.final),
      'the final image is displayed at the new address',
    );
  },
};
