// The laboratory without a server: saving, links, tabs, what needs the program, an engine that stops, and a phone.
import { execFileSync } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { deflateSync } from 'node:zlib';

export const engine = 'browser';

const PHONE = { width: 390, height: 844, touch: true };
const linkOf = (text) => `#scene=${deflateSync(text).toString('base64url')}`;
const film = (screen) => screen.page.evaluate(() => window.lab.image.film_hash);
const rod = (lab, from, to) => readFile(`${lab.folder}/scenes/rod.yaml`, 'utf8').then((text) => text.replace(from, to));

/** The downloaded file of an act: [name, text]. */
async function downloaded(screen, act) {
  const [file] = await Promise.all([screen.page.waitForEvent('download'), act()]);
  return [file.suggestedFilename(), await readFile(await file.path(), 'utf8')];
}

/** Follows a link that changes only the fragment of the page's address. */
async function follow(screen, link) {
  const before = await screen.page.evaluate(() => window.lab.newestGeneration);
  await screen.page.evaluate((hash) => {
    location.hash = hash;
  }, link);
  await screen.until((g) => window.lab.newestGeneration > g, before);
  await screen.settled();
}

/** Moves one finger over the image; then() before it is lifted. */
async function touchDrag(screen, from, to, then) {
  const client = await screen.context.newCDPSession(screen.page);
  const [a, b] = [await screen.place(...from), await screen.place(...to)];
  const send = (type, points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points });
  await send('touchStart', [a]);
  for (let i = 1; i <= 8; i++)
    await send('touchMove', [{ x: a.x + ((b.x - a.x) * i) / 8, y: a.y + ((b.y - a.y) * i) / 8 }]);
  await then?.();
  await send('touchEnd', []);
}

export const cases = {
  'the film is that of the program': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const { film_hash: own } = JSON.parse(await lab.run('render', 'scenes/rod.yaml', '--json'));
    t.equal(await film(screen), own, 'the film');
    t.equal((await lab.get('/api/state')).engine, 'browser', 'the engine of the state');
    t.match(await screen.page.locator('#status').innerText(), /time in this browser/i, 'the label of the time');
  },

  'saving downloads the scene, with a value that is being typed': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Parameters');
    await screen.page.getByRole('spinbutton', { name: 'liquid ior, number', exact: true }).first().fill('1.5');
    const [name, text] = await downloaded(screen, () => screen.page.keyboard.press('Control+s'));
    t.equal(name, 'rod.yaml', 'the name of the file');
    t.match(text, /ior: 1\.5/, 'the file has the typed index');
    await screen.until(() => window.lab.state.saved);

    await screen.showPanel('Objects');
    await screen.button('Save as …').click();
    await screen.page.getByLabel('File name', { exact: true }).fill('denser');
    const [other] = await downloaded(screen, () => screen.button('Save', true).last().click());
    t.equal(other, 'denser.yaml', 'the name of the file that was saved as another');
  },

  'a link opens, also in a page that is open': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab);
    const link = linkOf(await rod(lab, /ior: [\d.]+/, 'ior: 1.45'));
    const { film_hash: own } = JSON.parse(await lab.run('render', link, '--json'));
    await follow(screen, link);
    t.equal(await film(screen), own, 'the film of the link in an open page');
    t.check(await screen.stage.isVisible(), 'the gallery covers the image');

    await screen.page.goto('about:blank');
    await screen.page.goto(`${lab.home}${link}`);
    await screen.until(() => window.lab?.state?.undo && window.lab.image);
    await screen.settled();
    t.equal(await film(screen), own, 'the film of the link in a new page');
    t.check(await screen.stage.isVisible(), 'the gallery covers the image of a new page');
  },

  'a bad scene of a link is refused as by the program': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const link = linkOf(await rod(lab, 'radius', 'raduis'));
    let said = '';
    try {
      execFileSync(t.program, ['render', link, '--json'], { stdio: 'pipe' });
    } catch (error) {
      said = String(error.stderr);
    }
    const [, located, remedy] = said.match(/^cuvette: (link:\d+:\d+: .*); (.*)/) ?? [];
    t.check(located, `the program names no place: ${said}`);
    const before = await film(screen);
    await screen.page.evaluate((hash) => {
      location.hash = hash;
    }, link);
    const message = screen.page.locator('.status-message.error');
    await message.waitFor();
    const shown = await message.innerText();
    t.check(shown.includes(located) && shown.includes(remedy), `${shown}, not ${located}; ${remedy}`);
    await screen.settled();
    t.equal(await film(screen), before, 'the film before');
  },

  'a lesson of a link opens': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab);
    const { lessons } = await lab.get('/api/lessons');
    await screen.page.goto('about:blank');
    await screen.page.goto(`${lab.home}#lesson=${lessons[0].name}`);
    await screen.page.getByRole('heading', { level: 3, name: lessons[0].title }).waitFor();
    t.check(await screen.stage.isVisible(), 'the gallery covers the image');
  },

  'what needs the program says so, with its commands': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const { page } = screen;
    for (const [name, command] of [
      ['Studies', 'cuvette study run depth.study'],
      ['Machine', 'cuvette machine'],
    ]) {
      await screen.showPanel(name);
      const panel = page.getByRole('tabpanel', { name });
      await panel.getByText(command, { exact: true }).waitFor();
      await t.axe(screen, name);
      await t.image(screen, `browser-${name.toLowerCase()}`);
    }
    await screen.showPanel('Parameters');
    for (const [method, path] of [
      ['GET', '/api/machine'],
      ['GET', '/api/studies'],
    ]) {
      const reply = await lab.ask(method, path);
      t.equal(reply.status, 501, `${method} ${path}`);
      t.match(new TextDecoder().decode(reply.bytes), /"remedy": ?".*cuvette/, `the remedy of ${path}`);
    }
  },

  'each tab has its own scene': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const [one, two] = [await t.open(lab), await t.open(lab)];
    const before = await film(one);
    await two.setNumber('liquid.ior', 1.6);
    t.check((await film(two)) !== before, 'the film of the changed scene');
    t.equal(await film(one), before, 'the film of the other tab');
  },

  'a laboratory that stops says so, and the unsaved scene is offered again': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.setNumber('liquid.ior', 1.6);
    const changed = await film(screen);
    await screen.until(() => sessionStorage.getItem('cuvette.scene'));
    const workers = screen.page.workers();
    const which = await Promise.all(
      workers.map((each) => each.evaluate(() => typeof startLab === 'function' && lab !== null)),
    );
    const worker = workers[which.indexOf(true)];
    screen.expect(/broken on purpose/);
    await worker.evaluate(() => {
      setTimeout(() => {
        throw new Error('broken on purpose');
      });
    });
    const banner = screen.page.locator('#banner');
    await banner.getByText('The laboratory in this page stopped: Uncaught Error: broken on purpose.').waitFor();
    t.match(await banner.innerText(), /Reload the page/, 'the remedy');
    t.check(!/server|terminal/.test(await screen.page.locator('body').innerText()), 'words about a server');
    await screen.page.reload();
    await screen.until(() => window.lab?.image?.final);
    t.check((await film(screen)) !== changed, 'the scene of the file after a reload');
    await t.axe(screen, 'the offer of the unsaved scene');
    await screen.page.locator('#rescue').getByRole('button', { name: 'Open' }).click();
    await screen.until((hash) => window.lab.image.film_hash === hash, changed);
    t.equal(await screen.page.locator('#rescue').isVisible(), false, 'the offer after it was accepted');
  },

  'a reload, Back and Forward show the scene and the lesson with their changes': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const { page } = screen;
    const kept = () => screen.until(() => sessionStorage.getItem('cuvette.scene'));
    const shows = (hash) => screen.until((wanted) => window.lab?.image?.film_hash === wanted, hash);
    await screen.setNumber('liquid.ior', 1.6);
    const changed = await film(screen);
    await kept();
    await page.reload();
    await shows(changed);
    t.equal(await page.locator('#rescue').isVisible(), false, 'an offer of what is shown');
    await page.goto('about:blank');
    await page.goBack();
    await shows(changed);
    const [first] = (await lab.get('/api/lessons')).lessons;
    await page.goto('about:blank');
    await page.goto(`${lab.home}#lesson=${first.name}`);
    await page.getByRole('heading', { name: first.title }).waitFor();
    await screen.settled();
    await screen.button('Show the measurement').click();
    await page.locator('.lesson-value').waitFor();
    await page.reload();
    await page.locator('.lesson-value').waitFor();
    t.equal(await page.evaluate(() => location.hash), `#lesson=${first.name}`, 'the address names the lesson');
  },

  'a lesson on a phone': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab, PHONE);
    await screen.page.getByRole('button', { name: /When water becomes a mirror/ }).tap();
    await screen.button('Show the measurement').tap();
    await screen.page.locator('.lesson-value').waitFor();
    await screen.settled();
    await screen.page.locator('.section-ray').first().waitFor();
    await t.image(screen, 'browser-phone-lesson');
  },

  'a pixel and a shared link on a phone': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab, PHONE);
    await follow(screen, linkOf(await rod(lab, /ior: [\d.]+/, 'ior: 1.45')));
    await t.image(screen, 'browser-phone-link');
    await screen.chooseTool('Inspect');
    const at = await screen.place(400, 300);
    await screen.page.touchscreen.tap(at.x, at.y);
    await screen.page.getByRole('treegrid', { name: 'Rays of the pixel' }).waitFor();
    t.match(await screen.page.getByRole('tabpanel', { name: 'Pixel' }).innerText(), /Radiance/, 'the panel Pixel');
    await t.image(screen, 'browser-phone-pixel');
  },

  'the slime on a phone': async (t) => {
    const lab = await t.lab('scenes/slime.yaml');
    const screen = await t.open(lab, PHONE);
    await lab.post('/api/set', { set: { 'toy.script': '', 'toy.time_s': 0 } });
    await screen.showPanel('Slime');
    await screen.button('Play').tap();
    await screen.until(() => window.lab.slime.playing && window.lab.slime.time_s > 0.1);
    await screen.chooseTool('Grab');
    await touchDrag(screen, [400, 330], [330, 250], async () => {
      await screen.until(() => window.lab.slime.held > 0);
      await t.image(screen, 'browser-phone-slime');
    });
    await screen.until(() => window.lab.slime.held === 0);
    t.equal((await lab.get('/api/state')).slime.trouble, null, 'the error of the slime');
  },
};
