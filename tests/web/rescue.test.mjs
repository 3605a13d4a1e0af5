// A laboratory that was killed: the next one offers its unsaved scene; a disk that fails is reported once.
import { existsSync, readdirSync, rmSync, writeFileSync, mkdirSync } from 'node:fs';
import { join } from 'node:path';

const film = (screen) => screen.page.evaluate(() => window.lab.image.film_hash);
const bar = (screen) => screen.page.locator('#rescue');

/** The files of unsaved scenes. */
function kept(lab) {
  const folder = join(lab.state, 'cuvette');
  return existsSync(folder) ? readdirSync(folder).filter((name) => name.startsWith('unsaved-')) : [];
}

async function until(what, so) {
  for (let i = 0; i < 6000 && !so(); i++) await new Promise((resolve) => setTimeout(resolve, 50));
  if (!so()) throw new Error(`not within 300 s: ${what}`);
}

/** Changes values, kills the program when it has kept them, and starts it again at another address. */
async function crash(lab, values, scene = 'scenes/rod.yaml') {
  const before = kept(lab).length;
  await lab.post('/api/set', { set: values });
  await until('the scene is kept', () => kept(lab).length > before);
  await lab.stop('SIGKILL');
  await lab.serve(scene);
}

export const cases = {
  'an unsaved scene is opened again after a crash': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const first = await t.open(lab);
    t.equal(await bar(first).isVisible(), false, 'a bar without a rescued scene');
    await first.setNumber('liquid.ior', 1.6);
    const changed = await film(first);
    await until('the scene is kept', () => kept(lab).length === 1);
    await first.close();
    await lab.stop('SIGKILL');
    await lab.serve('scenes/rod.yaml');

    const screen = await t.open(lab);
    const { page } = screen;
    await bar(screen).waitFor();
    const words = await bar(screen).textContent();
    t.check(/An unsaved scene of .*\d:\d\d.* was rescued: .*scenes\/rod\.yaml/.test(words), `the bar: ${words}`);
    t.equal((await film(screen)) === changed, false, 'the scene of the file is shown until then');
    await t.axe(screen, 'with the bar');
    await t.image(screen, 'rescue-light');
    await page.emulateMedia({ colorScheme: 'dark' });
    await t.axe(screen, 'with the bar, dark');
    await t.image(screen, 'rescue-dark');
    await page.emulateMedia({ colorScheme: 'light' });

    const { generation } = await lab.get('/api/state');
    await page.getByRole('button', { name: 'Open', exact: true }).first().click();
    await screen.settled(generation + 1);
    await bar(screen).waitFor({ state: 'hidden' });
    t.equal(await film(screen), changed, 'the film of the rescued scene');
    t.equal(await lab.value('liquid.ior'), 1.6, 'its value');
    t.equal((await lab.get('/api/state')).file, 'scenes/rod.yaml', 'the file to save into');
    t.equal(await page.locator('.unsaved').isVisible(), true, 'it is still unsaved');
    await screen.button('Undo').click();
    await screen.settled(generation + 2);
    t.equal((await film(screen)) === changed, false, 'undo restores the scene before');
    await screen.button('Redo').click();
    await screen.settled(generation + 3);
    await lab.post('/api/save', { file: 'scenes/rod.yaml', replace: true });
    await until('no scene is kept after saving', () => kept(lab).length === 0);
    await screen.close();
    await lab.stop('SIGKILL');
    await lab.serve('scenes/rod.yaml');
    t.equal((await lab.get('/api/state')).rescued.length, 0, 'offers after saving');
    t.equal(await lab.value('liquid.ior'), 1.6, 'the saved value');
  },

  'scenes are offered one after the other, and discarded': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await crash(lab, { 'liquid.ior': 1.5 });
    await new Promise((resolve) => setTimeout(resolve, 1100)); // the times differ
    await crash(lab, { 'liquid.ior': 1.7 });
    const screen = await t.open(lab, { width: 390, height: 844 });
    const { page } = screen;
    await bar(screen).getByText('(and 1 more)').waitFor();
    await t.image(screen, 'rescue-phone');
    await t.axe(screen, 'two scenes on a telephone');
    const dialog = page.getByRole('dialog');
    await page.locator('#rescue').getByRole('button', { name: 'Discard' }).click();
    await dialog.getByRole('button', { name: 'Cancel' }).click();
    t.equal((await lab.get('/api/state')).rescued.length, 2, 'nothing is discarded by Cancel');
    await page.locator('#rescue').getByRole('button', { name: 'Discard' }).click();
    await dialog.getByRole('button', { name: 'Discard' }).click();
    await page.waitForFunction(() => !document.querySelector('#rescue').textContent.includes('more'));
    t.equal(kept(lab).length, 1, 'files after the newer one is discarded');
    t.equal((await lab.value('liquid.ior')) === 1.5, false, 'the scene itself is unchanged');
    const { generation } = await lab.get('/api/state');
    await page.locator('#rescue').getByRole('button', { name: 'Open' }).click();
    await screen.settled(generation + 1);
    t.equal(await lab.value('liquid.ior'), 1.5, 'the older one');
  },

  'a folder that cannot be written is reported once': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await lab.stop();
    rmSync(lab.state, { recursive: true, force: true });
    writeFileSync(lab.state, 'a file instead of a folder');
    // In its sandbox the laboratory could not write into a folder that is made later.
    await lab.serve('scenes/rod.yaml', [], { CUVETTE_SANDBOX: 'off' });
    const screen = await t.open(lab);
    t.equal(await bar(screen).isVisible(), false, 'a report before anything is unsaved');
    await screen.setNumber('liquid.ior', 1.6);
    await bar(screen).getByText('Unsaved changes would be lost in a crash').waitFor();
    await t.axe(screen, 'with the report');
    await t.image(screen, 'rescue-unkept');
    await bar(screen).getByRole('button', { name: 'Close' }).click();
    await screen.setNumber('liquid.ior', 1.7);
    t.equal(await bar(screen).isVisible(), false, 'a second report');
    t.equal(await lab.value('liquid.ior'), 1.7, 'the laboratory goes on');
    rmSync(lab.state);
    mkdirSync(lab.state);
    await screen.setNumber('liquid.ior', 1.8);
    await until('the scene is kept when it can be', () => kept(lab).length === 1);
    t.equal((await lab.get('/api/state')).unkept, null, 'the state reports no trouble any more');
  },
};
