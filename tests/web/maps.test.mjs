// Maps of the rays and the time of each pixel: the map of the rays is the file of `cuvette render --rays`, the numbers
// agree with those of the image, and the page draws the map over the image with a legend in units.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { readPng } from './png.mjs';
import { difference } from './screen.mjs';

const SCENE = 'scenes/rod.yaml';

/** The upper part of an image. */
const top = ({ width, data }, height) => ({ width, height, data: data.subarray(0, 4 * width * height) });

const mapOf = async (lab, name) => readPng((await lab.ask('GET', `/api/maps/${name}.png`)).bytes);

export const cases = {
  'the maps and their numbers': async (t) => {
    const lab = await t.lab(SCENE);
    const maps = await lab.get('/api/maps');
    const { image } = await lab.get('/api/state');
    t.equal([maps.serial, maps.width, maps.height], [image.serial, image.full_width, image.full_height], 'image');
    t.equal(maps.rays.total, image.rays, 'sum of the rays of all pixels');
    t.equal([maps.rays.unit, maps.time.unit, maps.cut.unit], ['rays', 'ns', ''], 'units');
    const share = maps.cut.total / (maps.width * maps.height);
    t.near(share, image.cut, 1e-9, 'the mean of the map, and the share of the image');
    t.more(maps.time.total, 0, 'sum of the times of all pixels');
    t.less(maps.time.total, 1.05e9 * maps.wall_s * maps.threads, 'ns of all pixels, of the time of all threads');

    await lab.run('render', SCENE, '--rays', 'rays.png', '--time', 'time.png', '-o', 'image.png');
    const rays = await mapOf(lab, 'rays');
    const written = readPng(await readFile(join(lab.folder, 'rays.png')));
    t.equal([rays.width, rays.height], [maps.image.width, maps.image.height], 'size of the map');
    t.equal(difference(rays, written), 0, 'share of pixels that differ from the file of the program');
    const time = await mapOf(lab, 'time');
    const { width, height } = readPng(await readFile(join(lab.folder, 'time.png')));
    t.equal([time.width, time.height], [width, height], 'size of the map of the times');
    const again = await mapOf(lab, 'time');
    t.equal(difference(time, again), 0, 'the times are measured once');

    const missing = await lab.ask('GET', '/api/maps/heat.png');
    t.equal(missing.status, 404, 'a map that does not exist');
    const { generation } = await lab.post('/api/set', { set: { 'render.depth': 1 } });
    const less = await lab.get('/api/maps');
    t.check(less.rays.total < maps.rays.total, `fewer rays at depth 1: ${less.rays.total} of ${maps.rays.total}`);
    t.equal((await lab.get('/api/state')).image.generation, generation, 'the maps are those of the changed scene');
  },

  'the page draws a map with a legend': async (t) => {
    for (const dark of [false, true]) {
      const lab = await t.lab(SCENE);
      const screen = await t.open(lab, { width: 1920, height: 1080, dark });
      await screen.actualSize();
      await screen.showPanel('Compare');
      const part = screen.page
        .getByRole('tabpanel', { name: 'Compare' })
        .locator('details')
        .filter({ hasText: 'Cost of each pixel' });
      const show = (name) => part.getByText(name, { exact: true }).click();
      await show('Rays');
      await part.getByText('rays per pixel', { exact: true }).waitFor();
      await screen.page.getByText('Rays per pixel', { exact: true }).waitFor();
      await screen.quiet();
      const whole = await mapOf(lab, 'rays');
      const seen = async () => {
        const { height } = await lab.get('/api/maps');
        return difference(
          await screen.displayed(),
          top(await mapOf(lab, 'rays'), height),
          (x, y) => y > 60 && y < height - 60,
        );
      };
      t.less(await seen(), 0.001, 'share of pixels that differ from the map');
      await t.axe(screen, 'the map of the rays');
      await t.image(screen, `map-rays-${dark ? 'dark' : 'light'}`);

      const [saved] = await Promise.all([
        screen.page.waitForEvent('download'),
        part.getByRole('button', { name: 'Save this map' }).click(),
      ]);
      t.equal(saved.suggestedFilename(), 'rod-rays.png', 'name of the saved map');
      const file = readPng(await readFile(await saved.path()));
      t.equal(difference(file, await mapOf(lab, 'rays')), 0, 'the saved map is that of the program');

      // The map follows the scene.
      const { generation } = await lab.post('/api/set', { set: { 'render.depth': 1 } });
      await screen.settled(generation);
      await screen.until(
        (serial) => document.querySelector(`[data-path*="rays.png?of=${serial}"]`),
        (await lab.get('/api/maps')).serial,
      );
      await screen.quiet();
      t.more(difference(whole, await mapOf(lab, 'rays')), 0.1, 'share of pixels of the map that a change altered');
      t.less(await seen(), 0.001, 'share of pixels that differ from the new map');

      await show('Time');
      await part.getByText('ns per pixel', { exact: true }).waitFor();
      t.match(
        await part.innerText(),
        /Measured once (on this machine|in this browser), in one frame of .* with \d+ thread/,
        'label',
      );
      await screen.quiet();
      await t.axe(screen, 'the map of the times');
      await t.image(screen, `map-time-${dark ? 'dark' : 'light'}`);
      await screen.button('Close: Time per pixel').click();
      t.equal(difference(await screen.pixels(), await screen.served()), 0, 'the image again');
      t.equal(await screen.page.locator('.layer-cost').isVisible(), false, 'the map is removed');
    }
  },
};
