// A scene of 10 000 solids: the page builds what is seen, requests the parameters that it shows, and takes only what
// differs. Counts are checked; times are reported, because they depend on the machine.
import { writeFile } from 'node:fs/promises';
import { join } from 'node:path';

const COUNT = 10000;
const NODES_MAX = 3500; // elements of the page, as with a scene of one solid
const ROWS_MAX = 300; // rows of parameters in the page

/** Spheres in a box, placed by a fixed sequence. */
function manySolids(count) {
  let seed = 1;
  const random = (size) => ((seed = (seed * 16807) % 2147483647) / 2147483647) * size;
  const place = () => [random(10) - 5, random(3), random(10) - 5].map((x) => x.toFixed(3)).join(', ');
  return [
    'camera: {position: [0, 6, -14], target: [0, 1, 0], fov_deg: 40}',
    'render: {width: 160, height: 120}',
    'lights:\n  lamp: {position: [5, 9, -7]}',
    'solids:\n  ground: {shape: plane}',
    ...Array.from({ length: count }, (_, i) => `  s${i}: {shape: sphere, position: [${place()}], radius: 0.05}`),
  ].join('\n');
}

const elements = (screen) => screen.page.evaluate(() => document.querySelectorAll('*').length);

/** Milliseconds of the longest task of the page while f runs there. */
const change = (screen) =>
  screen.page.evaluate(async () => {
    const tasks = [0];
    const watch = new PerformanceObserver((list) => tasks.push(...list.getEntries().map((each) => each.duration)));
    watch.observe({ type: 'longtask' });
    const began = performance.now();
    const known = window.lab.scene.objects;
    const arrived = new Promise((resolve) => {
      const end = window.lab.on('scene', () => window.lab.param('s7000.radius').value === 0.07 && resolve(end()));
    });
    await window.lab.set({ 's7000.radius': 0.07 });
    await arrived;
    watch.disconnect();
    const { objects } = window.lab.scene;
    return { ms: performance.now() - began, longest: Math.max(...tasks), kept: objects === known };
  });

export const cases = {
  'ten thousand solids: what is seen is built, and found': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await writeFile(join(lab.folder, 'many.yaml'), manySolids(COUNT));
    await lab.post('/api/open', { file: 'many.yaml' });
    const screen = await t.open(lab);
    await screen.until((count) => window.lab.scene?.objects.length === count + 2, COUNT);
    const opened = await screen.page.evaluate(() => performance.now());
    t.check((await elements(screen)) < NODES_MAX, `${await elements(screen)} elements`);
    await screen.showPanel('Objects');
    t.check((await elements(screen)) < NODES_MAX, `${await elements(screen)} elements with the list of objects`);
    const { page } = screen;
    const item = page.locator('.object-list .object-item', { hasText: /^s7000 / });
    await page.getByRole('searchbox', { name: 'Find an object by name' }).fill('s7000');
    await item.click();
    await screen.until(() => window.lab.param('s7000.radius'));
    t.check(await screen.page.evaluate((most) => window.lab.scene.params.length < most, ROWS_MAX), 'few rows');

    const asked = await screen.asked();
    const { ms, longest, kept } = await change(screen);
    console.log(`   10 000 solids: ${opened.toFixed(0)} ms to open, a change ${ms.toFixed(0)} ms, of the page's own`);
    console.log(`   at most ${longest.toFixed(0)} ms at once`);
    t.check(kept, 'the list of objects stays the same array');
    const path = asked.find((each) => each.startsWith('/api/scene?since='));
    const reply = await lab.get(`${path}`);
    t.check(JSON.stringify(reply).length < 100000, `${JSON.stringify(reply).length} bytes of differences`);

    await page.getByRole('searchbox', { name: 'Find an object by name' }).fill('');
    const list = page.getByRole('list', { name: 'Solids' });
    await list.locator('[tabindex="0"]').focus();
    await page.keyboard.press('End');
    await screen.until(() => document.activeElement.textContent.startsWith('s9999'));
    const last = await page.evaluate(() => {
      const li = document.activeElement.closest('li');
      return [li.ariaSetSize, li.ariaPosInSet];
    });
    t.equal(last, [String(COUNT + 1), String(COUNT + 1)], 'screen readers hear which of how many it is');

    await screen.showPanel('Parameters');
    await page.getByRole('searchbox', { name: /Find a parameter/ }).fill('s4321 radius');
    await page.locator('.param[data-path="s4321.radius"]').waitFor();
    t.check((await elements(screen)) < NODES_MAX, `${await elements(screen)} elements with what was found`);
  },
};
