// Videos recorded in the browser: number, size and times of the frames, which show what the image and the drawing over
// it show; stop, wrong entries, and the scene as before.
import { readFile } from 'node:fs/promises';

const SIZE = [160, 120];

async function opened(t, scene, values = {}) {
  const lab = await t.lab(scene);
  const screen = await t.open(lab);
  const { generation } = await lab.post('/api/set', {
    set: { 'render.width': SIZE[0], 'render.height': SIZE[1], ...values },
  });
  await screen.settled(generation);
  return { lab, screen };
}

async function dialog(screen, kind, numbers) {
  await screen.button('Save video').click();
  const box = screen.page.getByRole('dialog', { name: 'Save video' });
  await box.getByRole('radiogroup', { name: 'What changes' }).getByText(kind, { exact: true }).click();
  for (const [name, value] of Object.entries(numbers))
    if (name === 'Parameter') await box.getByRole('combobox', { name }).fill(value);
    else await box.getByLabel(name, { exact: true }).fill(value);
  return box;
}

async function recorded(screen, box) {
  await box.getByRole('button', { name: 'Record' }).click();
  await box.getByLabel('The video').waitFor();
  const [saved] = await Promise.all([
    screen.page.waitForEvent('download'),
    box.getByRole('button', { name: 'Save file' }).click(),
  ]);
  return { name: saved.suggestedFilename(), bytes: await readFile(await saved.path()) };
}

/** The image of an index as the page saves it, with its rays. */
async function withRays(lab, screen, ior) {
  await lab.post('/api/set', { set: { 'liquid.ior': ior } }).then((reply) => screen.settled(reply.generation));
  await screen.button('Save image').click();
  const box = screen.page.getByRole('dialog', { name: 'Save image' });
  await box.getByLabel('With rays, angles and ruler').check();
  const [saved] = await Promise.all([
    screen.page.waitForEvent('download'),
    box.getByRole('button', { name: 'Save' }).click(),
  ]);
  return readFile(await saved.path());
}

/** Plays the video of the dialog: its length and size, how many different frames there are in the middle of each
 * frame's time, and the mean difference of frame `at` to an image, 0..255. */
const played = (screen, frames, fps, at, png) =>
  screen.page.evaluate(
    async ([frames, fps, at, png]) => {
      const video = document.querySelector('dialog video');
      if (video.readyState < 1) await new Promise((resolve) => video.addEventListener('loadedmetadata', resolve));
      const { videoWidth: width, videoHeight: height } = video;
      const context = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
      const pixels = (source) => {
        context.drawImage(source, 0, 0);
        return context.getImageData(0, 0, width, height).data;
      };
      const shots = [];
      for (let i = 0; i < frames; i++) {
        video.currentTime = (i + 0.5) / fps;
        await new Promise((resolve) => video.addEventListener('seeked', resolve, { once: true }));
        shots.push(pixels(video));
      }
      const difference = (a, b) => a.reduce((sum, each, i) => sum + Math.abs(each - b[i]), 0) / a.length;
      const steps = shots.slice(1).map((shot, i) => difference(shot, shots[i]));
      const wanted = pixels(await createImageBitmap(new Blob([Uint8Array.from(atob(png), (c) => c.charCodeAt(0))])));
      return {
        size: [width, height],
        duration: video.duration,
        least: Math.min(...steps),
        own: difference(shots[at], wanted),
        other: difference(shots[at === 0 ? frames - 1 : 0], wanted),
      };
    },
    [frames, fps, at, Buffer.from(png).toString('base64')],
  );

export const cases = {
  'a parameter: the frames are the images of its values, with the rays': async (t) => {
    const { lab, screen } = await opened(t, 'scenes/rod.yaml');
    await lab.post('/api/objects', { kind: 'beam' });
    const { generation } = await lab.post('/api/set', {
      set: { 'laser.position': [-2.5, 1.6, -0.4], 'laser.target': [0, 1.4, -0.4] },
    });
    await screen.settled(generation);
    await screen.page.locator('.layer-bench .bench-ray').nth(3).waitFor({ state: 'attached' });
    const drawn = await withRays(lab, screen, 1.6);
    await lab.post('/api/set', { set: { 'liquid.ior': 1.33 } }).then((reply) => screen.settled(reply.generation));
    const before = await lab.get('/api/state');
    const box = await dialog(screen, 'A parameter', {
      Parameter: 'liquid.ior',
      From: '1',
      To: '1,6',
      Frames: '6',
      Rate: '10',
    });
    await box.getByLabel('With rays, angles and ruler').check();
    await box.getByText(/6 frames, 600 ms long/).waitFor();
    const file = await recorded(screen, box);
    t.equal(file.name, 'rod.webm', 'name');
    t.equal(file.bytes.readUInt32BE(0), 0x1a45dfa3, 'head of a WebM file');
    const after = await lab.get('/api/state');
    t.equal(after.undo, before.undo, 'the last step of undo is that from before');
    t.equal((await lab.get('/api/scene')).params.find(({ path }) => path === 'liquid.ior').value, 1.33, 'the value');
    await t.axe(screen, 'Save video');
    await t.image(screen, 'video');

    const film = await played(screen, 6, 10, 5, drawn);
    t.equal(film.size, SIZE, 'size');
    t.check(Math.abs(film.duration - 0.6) < 0.002, `0.6 s long: ${film.duration}`);
    t.check(film.least > 0.05, `every frame differs from the one before: ${film.least}`);
    t.check(film.own < 3 && film.own < film.other / 2, `the last frame: ${film.own}, the first: ${film.other}`);
  },

  'the camera orbits once, and is where it was': async (t) => {
    const { lab, screen } = await opened(t, 'scenes/rod.yaml');
    const before = await lab.get('/api/state');
    const first = (await lab.ask('GET', '/api/image.png?wait=1')).bytes;
    const box = await dialog(screen, 'The camera orbits', { Angle: '360', Frames: '4', Rate: '2' });
    await recorded(screen, box);
    const film = await played(screen, 4, 2, 0, first);
    t.check(Math.abs(film.duration - 2) < 0.002 && film.least > 1, `${film.duration} s, ${film.least}`);
    t.check(film.own < 3 && film.own < film.other / 2, `the first frame: ${film.own}, the last: ${film.other}`);
    const after = await lab.get('/api/state');
    t.equal([after.camera, after.saved, after.undo], [before.camera, before.saved, before.undo], 'view and scene');
  },

  'the slime moves from rest; wrong entries are refused; a recording is stopped': async (t) => {
    const { lab, screen } = await opened(t, 'scenes/slime.yaml', { 'toy.level': 2 });
    const box = await dialog(screen, 'The slime moves', { Duration: '0,4', Rate: '10' });
    await recorded(screen, box);
    const { generation } = await lab.post('/api/set', { set: { 'toy.time_s': 0.3 } });
    await screen.settled(generation);
    const film = await played(screen, 4, 10, 3, (await lab.ask('GET', '/api/image.png?wait=1')).bytes);
    t.check(film.own < 3 && film.own < film.other, `the last frame: ${film.own}, the first: ${film.other}`);

    await box.getByRole('radiogroup', { name: 'What changes' }).getByText('A parameter', { exact: true }).click();
    for (const [name, value, words] of [
      ['Parameter', 'camera.position', /whose value is a number/],
      ['Parameter', 'render.width', null],
      ['From', '160', null],
      ['To', '', /Enter a number/],
      ['To', '80', null],
      ['Frames', '1001', /2 to 1000 frames/],
      ['Frames', '3', /the size of the frames changes/],
    ]) {
      const input = name === 'Parameter' ? box.getByRole('combobox', { name }) : box.getByLabel(name, { exact: true });
      await input.fill(value);
      if (!words) continue;
      await box.getByRole('button', { name: 'Record' }).click();
      await box.getByText(words).waitFor();
    }
    await box.getByLabel('To', { exact: true }).fill('160');
    await box.getByLabel('Frames', { exact: true }).fill('1000');
    await box.getByRole('button', { name: 'Record' }).click();
    await box.getByText(/[1-9] of 1000 frames, about/).waitFor();
    await box.getByRole('button', { name: 'Stop' }).click();
    await box.getByText('Stopped.').waitFor();
    t.equal(await box.getByLabel('The video').count(), 0, 'no file of a stopped video');
    t.equal((await lab.get('/api/scene')).params.find(({ path }) => path === 'render.width').value, 160, 'the width');
  },

  'without a video encoder the frames are played to a recorder': async (t) => {
    const { screen } = await opened(t, 'scenes/rod.yaml');
    await screen.page.evaluate(() => delete globalThis.VideoEncoder);
    const box = await dialog(screen, 'A parameter', {
      Parameter: 'liquid.ior',
      From: '1',
      To: '2',
      Frames: '5',
      Rate: '5',
    });
    await box.getByText('The times of the frames are those of a clock').waitFor();
    const file = await recorded(screen, box);
    t.equal(file.bytes.readUInt32BE(0), 0x1a45dfa3, 'head of a WebM file');
    t.check(file.bytes.length > 1000, `${file.bytes.length} bytes`);
  },
};
