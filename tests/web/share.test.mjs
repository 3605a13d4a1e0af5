// Scenes shared by link, PNG image and HTML file: the film is the same. QR codes, frames and printed pages.
import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { QR_MOST, qrCode } from '../../src/web/page/shared/qr.js';

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

  // The modules are those of node-qrcode 1.5.4 for the same mask, and jsQR 1.4.0 reads the texts from them.
  'QR codes of versions 1, 7, 20 and 40': async (t) => {
    const link = (length) => 'https://cuvette.example/#scene='.padEnd(length, 'eNqNUsFuwjAM-_').slice(0, length);
    for (const [length, version, level, digest] of [
      [14, 1, 'M', '140fe030207b8844'],
      [150, 7, 'L', '386f46f4dae9ece8'],
      [800, 20, 'L', '418c3b163ede8b4d'],
      [2900, 40, 'L', 'a7771465d9cc012c'],
    ]) {
      const code = qrCode(link(length));
      t.equal(`${code.version} ${code.level}`, `${version} ${level}`, `version and level of ${length} characters`);
      const cells = Array.from({ length: code.size ** 2 }, (_, at) => at);
      const bits = cells.map((at) => (code.dark(at % code.size, Math.floor(at / code.size)) ? 1 : 0)).join('');
      t.equal(createHash('sha256').update(bits).digest('hex').slice(0, 16), digest, `modules of version ${version}`);
    }
    t.equal(qrCode(link(QR_MOST)).version, 40, 'the version of the longest text');
    t.equal(qrCode(link(QR_MOST + 1)), null, 'the code of a longer text');
  },

  'a frame has the image and the lesson of its address; both pages of the lesson are printed': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab);
    const { page } = screen;
    await page.goto('about:blank');
    await page.goto(`${lab.home}?embed=1#lesson=critical-angle`);
    await page.getByRole('heading', { name: 'When water becomes a mirror', level: 3 }).waitFor();
    await screen.settled();
    for (const [part, shown] of [
      ['.head', false],
      ['.tabs', false],
      ['.status-facts', false],
      ['.section-bar', true],
      ['.embed-link', true],
    ])
      t.equal(await page.locator(part).first().isVisible(), shown, `${part} of a frame`);
    await screen.until(() => document.querySelector('.embed-link').hash === '#lesson=critical-angle');
    t.equal(new URL(await page.locator('.embed-link').evaluate((link) => link.href)).search, '', 'the link');
    await t.axe(screen, 'a frame with a lesson');
    await t.image(screen, 'embed');
    await page.evaluate(() => {
      window.print = () => {
        window.printed = document.querySelector('.print-sheets');
      };
    });
    const cells = async (label) => {
      await screen.button(label).click();
      const found = await screen.until(() => {
        const all = [...(window.printed?.querySelectorAll('.sheet-table td') ?? [])];
        window.printed = null;
        return all.length && all.map((cell) => cell.textContent);
      });
      return found.jsonValue();
    };
    t.equal((await cells('Worksheet')).join(''), '', 'the blanks of the worksheet');
    const solved = await cells("Teacher's page");
    t.equal(solved.length, 10, 'numbers of five rows');
    t.check(
      solved.every((text, i) => text && (i % 2 || text === solved[i + 1])),
      `measured and theory: ${solved}`,
    );
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
