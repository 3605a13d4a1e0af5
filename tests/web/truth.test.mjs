// What the page shows belongs to the scene: old results are renewed, an untouched lesson is not unsaved, and at
// rest the image has the display's pixels, while it stays the film of the scene.
const size = { width: 1366, height: 768 };

export const cases = {
  'a result of an earlier scene is renewed where it is seen': async (t) => {
    const lab = await t.lab('tests/bench.yaml');
    const screen = await t.open(lab, size);
    const { page } = screen;
    await screen.showPanel('Bench');
    await page.getByText('Screen', { exact: true }).click();
    await screen.button('Expose').click();
    const facts = page.locator('.bench-screen-form .bench-result');
    const power = page.locator('.bench-screen-form').getByText(/^[\d.]+ of [\d.]+$/);
    await power.waitFor();
    const first = await power.textContent();
    await lab.ask('DELETE', '/api/objects/laser');
    await screen.until((before) => {
      const place = document.querySelector('.bench-screen-form .bench-result');
      return !place.textContent.includes(before) && !place.classList.contains('stale');
    }, first);
    t.check(await facts.isVisible(), `the screen was ${first}, now ${await power.textContent()}`);
    /* Out of sight it is marked, and renewed when it is seen again. */
    await page.locator('summary', { hasText: 'Screen' }).click();
    await lab.ask('POST', '/api/undo', {});
    await screen.until(() => document.querySelector('.bench-screen-form .bench-result').classList.contains('stale'));
    await page.locator('summary', { hasText: 'Screen' }).click();
    await power.filter({ hasText: first }).waitFor();
    t.check(true, 'renewed when it is seen');
  },

  'an untouched lesson is not unsaved, and a change of it is': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, size);
    const { lessons } = await lab.get('/api/lessons');
    await lab.ask('POST', `/api/lessons/${lessons[0].name}/open`, {});
    await screen.until(() => window.lab.state.file === null);
    t.check(!(await screen.page.locator('.unsaved').isVisible()), 'a lesson as it was opened');
    await lab.post('/api/set', { set: { 'render.depth': 9 } });
    await screen.page.locator('.unsaved').waitFor();
    t.check(await screen.page.locator('.unsaved').isVisible(), 'after a change');
  },

  'the image at rest has the pixels of the display': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await lab.post('/api/set', { set: { 'render.width': 160, 'render.height': 120 } });
    const screen = await t.open(lab, size);
    if (t.engine === 'browser') return t.check(true, 'an engine in a browser would be busy with it');
    const sharp = screen.page.waitForResponse((reply) => reply.url().includes('/api/display.png'));
    await lab.post('/api/set', { set: { 'liquid.ior': 1.4 } });
    await screen.settled();
    const { pathname, search } = new URL((await sharp).url());
    const width = Number(/\d+$/.exec(search)[0]);
    t.more(width, 320, 'the width of the request');
    const image = await screen.page.evaluate(() => ({ ...window.lab.image }));
    t.equal(
      [image.width, image.final, image.film_hash.length],
      [160, true, 16],
      'the image is still that of the scene',
    );
    t.equal((await screen.served(pathname + search)).width, width, 'the width of the reply');
    t.equal((await lab.ask('GET', '/api/display.png?width=100000')).status, 400, 'a width that is too large');
  },
};
