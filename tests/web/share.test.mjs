// Scenes shared by link, PNG image and HTML file: the film is the same.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

// A link that holds the scene: copied from one page, opened by another, the film is the same; undo goes back.
export const cases = {
  'a link reproduces the film': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const film = () => screen.page.evaluate(() => window.lab.image.film_hash);
    const first = await film();
    await screen.setNumber('liquid.ior', 1.6);
    const changed = await film();
    t.equal(changed === first, false, 'the change alters the film');
    const { fragment, code } = await lab.get('/api/link');
    const { generation } = await lab.get('/api/state');
    await lab.post('/api/undo', {});
    await screen.settled(generation + 1);
    t.equal(await film(), first, 'the film after undo');
    await screen.page.goto('about:blank'); // from there the address is loaded, not only its fragment changed
    await screen.page.goto(`${lab.home}${fragment}${code}`);
    await screen.until(() => window.lab?.state?.undo && window.lab.image);
    await screen.settled();
    t.equal(await film(), changed, 'the film of the link');
    const address = () => screen.page.evaluate(() => location.hash);
    t.equal(await address(), `${fragment}${code}`, 'the address names the scene');
    await screen.setNumber('liquid.ior', 1.7);
    const own = await film();
    const shows = (wanted) => screen.until((hash) => window.lab?.image?.film_hash === hash, wanted);
    await screen.page.reload();
    await shows(own);
    await screen.page.goto('about:blank');
    await screen.page.goBack();
    await shows(own);
    await lab.post('/api/undo', {});
    await shows(changed);
    t.equal((await lab.get('/api/state')).file, null, 'the scene of a link has no file');
  },

  'the dialog: link, image and page give the film again': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const { page } = screen;
    const film = () => page.evaluate(() => window.lab.image.film_hash);
    const first = await film();
    await page.context().grantPermissions(['clipboard-read', 'clipboard-write']);
    await screen.setNumber('liquid.ior', 1.45);
    const changed = await film();
    t.equal(changed === first, false, 'the change alters the film');
    await screen.showPanel('Objects');
    const open = () => screen.button('Share …').click();
    await open();
    await t.axe(screen, 'the dialog');
    await t.image(screen, 'share');

    await screen.button('Copy link').click();
    await page.waitForFunction(() => document.body.textContent.includes('Link copied'));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    t.equal(link.startsWith(`${lab.home}#scene=`), true, 'the link is of this address');
    const filmOf = (file) => JSON.parse(execFileSync(t.program, ['render', file, '--json'])).film_hash;
    t.equal(filmOf(link), changed, 'the film of the copied link');

    const folder = mkdtempSync(join(tmpdir(), 'cuvette-share-'));
    try {
      for (const [label, name] of [
        ['PNG with the scene', 'rod.png'],
        ['HTML file', 'rod.html'],
      ]) {
        const file = join(folder, name);
        await open();
        const [download] = await Promise.all([page.waitForEvent('download'), screen.button(label).click()]);
        await download.saveAs(file);
        t.equal(filmOf(file), changed, `the film of ${name}`);

        for (const way of ['chosen', 'dropped']) {
          const { generation } = await lab.get('/api/state');
          await lab.post('/api/undo', {});
          await screen.settled(generation + 1);
          t.equal(await film(), first, 'the film after undo');
          if (way === 'chosen') {
            await open();
            await page.locator('dialog input[type=file]').setInputFiles(file);
          } else await drop(page, file, name);
          await screen.settled(generation + 2);
          t.equal(await film(), changed, `the film of ${name}, ${way}`);
        }
      }
    } finally {
      rmSync(folder, { recursive: true });
    }
  },

  'a scene that names files is saved without it, and the page says so': async (t) => {
    const lab = await t.lab('scenes/chequer.yaml');
    const screen = await t.open(lab);
    const { page } = screen;
    screen.expect(/status of 409/);
    await screen.showPanel('Objects');
    const folder = mkdtempSync(join(tmpdir(), 'cuvette-share-'));
    try {
      for (const [label, name] of [
        ['PNG without the scene', 'chequer.png'],
        ['HTML file without the scene', 'chequer.html'],
      ]) {
        await screen.button('Share …').click();
        const dialog = page.getByRole('dialog', { name: 'Share' });
        await dialog.getByText(/No link, and files are saved without the scene: .* reads .*chequer\.png/).waitFor();
        t.equal(await dialog.getByText('Copy link').isVisible(), false, 'a link of such a scene');
        await t.axe(screen, 'the dialog of a scene that names files');
        await t.image(screen, 'share-without');
        const [download] = await Promise.all([page.waitForEvent('download'), screen.button(label).click()]);
        await page
          .getByText(new RegExp(`${name} saved without the scene: .*chequer\\.png`))
          .first()
          .waitFor();
        await t.image(screen, 'share-without-saved');
        const file = join(folder, name);
        await download.saveAs(file);
        let refused = '';
        try {
          execFileSync(t.program, ['render', file, '--json'], { stdio: 'pipe' });
        } catch (error) {
          refused = String(error.stderr);
        }
        t.check(refused !== '', `the program opens ${name} as a scene`);
      }
    } finally {
      rmSync(folder, { recursive: true });
    }
  },
};

function drop(page, file, name) {
  return page.evaluate(
    ([base64, as]) => {
      const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([bytes], as));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
    },
    [readFileSync(file).toString('base64'), name],
  );
}
