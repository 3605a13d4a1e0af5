// Videos: that of a parameter has the frames of `cuvette render`, that of a slime is the file of `cuvette animate`;
// progress, stop, refusals, and the dialog Save video.
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { readPng } from './png.mjs';
import { difference } from './screen.mjs';

const SCENE = 'scenes/rod.yaml';
const SMALL = { 'render.width': 120, 'render.height': 90 };
const sets = (values) => Object.entries(values).flatMap(([path, value]) => ['--set', `${path}=${value}`]);

/** Waits for the end of the video; the state's `video`. */
async function ended(lab) {
  for (;;) {
    const { video } = await lab.get('/api/state');
    if (!video.running) return video;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

const fileOf = async (lab) => Buffer.from((await lab.ask('GET', '/api/video/file')).bytes);

/** The chunks of a PNG file as [type, bytes with length and CRC, data]. */
function chunks(bytes) {
  const list = [];
  for (let at = 8; at < bytes.length;) {
    const size = bytes.readUInt32BE(at);
    list.push([
      bytes.toString('latin1', at + 4, at + 8),
      bytes.subarray(at, at + 12 + size),
      bytes.subarray(at + 8, at + 8 + size),
    ]);
    at += 12 + size;
  }
  return list;
}

/** The pixels of each frame of an animated PNG, compressed. */
function frames(bytes) {
  const list = [];
  for (const [type, , data] of chunks(bytes)) {
    if (type === 'fcTL') list.push([]);
    if (type === 'IDAT') list.at(-1).push(data);
    if (type === 'fdAT') list.at(-1).push(data.subarray(4));
  }
  return list.map((parts) => Buffer.concat(parts));
}

const pixelsOf = (png) =>
  Buffer.concat(
    chunks(png)
      .filter(([type]) => type === 'IDAT')
      .map(([, , data]) => data),
  );

async function refused(t, lab, body, code, words) {
  const reply = await lab.ask('POST', '/api/video', body);
  t.equal(reply.status, code, JSON.stringify(body));
  t.match(Buffer.from(reply.bytes).toString(), words, JSON.stringify(body));
}

export const cases = {
  'the film of a parameter has the frames of the command line': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/set', { set: SMALL });
    await lab.post('/api/video', { parameter: 'liquid.ior', from: 1, to: 1.6, frames: 5, fps: 10, format: 'apng' });
    const video = await ended(lab);
    t.equal([video.done, video.frames, video.error], [5, 5, null], 'frames');
    const film = await fileOf(lab);
    t.equal(film.length, video.bytes, 'bytes');
    const shown = frames(film);
    t.equal(shown.length, 5, 'frames of the file');
    for (const [i, ior] of [1, 1.15, 1.3, 1.45, 1.6].entries()) {
      await lab.run('render', SCENE, '-o', 'frame.png', ...sets({ ...SMALL, 'liquid.ior': ior }));
      t.check(pixelsOf(await readFile(join(lab.folder, 'frame.png'))).equals(shown[i]), `frame ${i} differs`);
    }
    const control = chunks(film).find(([type]) => type === 'fcTL')[2];
    t.equal([control.readUInt16BE(20), control.readUInt16BE(22)], [1, 10], 'time of a frame');
    const numbers = chunks(film)
      .filter(([type]) => type === 'fcTL' || type === 'fdAT')
      .map(([, , data]) => data.readUInt32BE(0));
    t.equal(
      numbers,
      numbers.map((_, i) => i),
      'sequence numbers',
    );

    // Integers are rounded.
    await lab.post('/api/video', { parameter: 'render.depth', from: 1, to: 4, frames: 3, format: 'y4m' });
    t.equal((await ended(lab)).error, null, 'a film of an integer');
    t.match((await fileOf(lab)).toString('latin1', 0, 60), /^YUV4MPEG2 W120 H90 F25:1 /, 'head');
  },

  'the film of a slime is the file of cuvette animate': async (t) => {
    const scene = 'scenes/slime.yaml';
    const lab = await t.lab(scene);
    await lab.post('/api/set', { set: { ...SMALL, 'toy.level': 2 } });
    const words = ['animate', scene, '--duration', '0.4', '--fps', '20', ...sets({ ...SMALL, 'toy.level': 2 })];
    for (const format of ['y4m', 'apng']) {
      await lab.post('/api/video', { duration_s: 0.4, fps: 20, format });
      t.equal((await ended(lab)).done, 8, 'frames');
      await lab.run(...words, '-o', `film.${format}`);
      t.check((await fileOf(lab)).equals(await readFile(join(lab.folder, `film.${format}`))), `film.${format} differs`);
    }
  },

  'a film is stopped, and wrong ones are refused': async (t) => {
    const lab = await t.lab(SCENE);
    const sweep = { parameter: 'liquid.ior', from: 1, to: 1.6, frames: 400 };
    t.equal((await lab.ask('GET', '/api/video/file')).status, 404, 'no film yet');
    t.equal((await lab.ask('POST', '/api/video/stop', {})).status, 409, 'nothing to stop');
    await refused(t, lab, {}, 409, /it has no slime/);
    await refused(t, lab, { ...sweep, frames: 1001 }, 400, /give 2 to 1000 frames/);
    await refused(t, lab, { ...sweep, frames: 2.5 }, 400, /give 2 to 1000 frames/);
    await refused(t, lab, { ...sweep, frames: 1000 }, 400, /more than 1 GiB/);
    await refused(t, lab, { ...sweep, parameter: 'liquid.iro' }, 400, /no such parameter/);
    await refused(t, lab, { ...sweep, parameter: 'camera.position' }, 400, /not a number/);
    await refused(t, lab, { ...sweep, parameter: 'render.width', from: 800, to: 400 }, 400, /size of the frames/);
    await refused(t, lab, { ...sweep, to: -1 }, 400, /liquid.ior/);
    await refused(t, lab, { ...sweep, fps: 0 }, 400, /from 1 to 240/);
    await refused(t, lab, { ...sweep, format: 'gif' }, 400, /use y4m or apng/);
    await lab.post('/api/video', sweep);
    await refused(t, lab, sweep, 409, /another video/);
    await lab.post('/api/video/stop', {});
    const video = await ended(lab);
    t.check(video.done < 400 && video.bytes === null && video.error === null, 'stopped');
    t.equal((await lab.ask('GET', '/api/video/file')).status, 404, 'no file of a stopped film');
  },

  'the dialog renders a film, plays it and saves it': async (t) => {
    for (const dark of [false, true]) {
      const lab = await t.lab(SCENE);
      const screen = await t.open(lab, { width: 1366, height: 900, dark });
      await screen.button('Save video').click();
      const box = screen.page.getByRole('dialog', { name: 'Save video' });
      await box.getByRole('combobox', { name: 'Parameter' }).fill('liquid.ior');
      await box
        .getByRole('textbox', { name: 'To' })
        .or(box.getByRole('spinbutton', { name: 'To' }))
        .fill('1,6');
      await box.getByLabel('Frames', { exact: true }).fill('6');
      await box.getByText(/6 frames, 240 ms long; about/).waitFor();
      await box.getByRole('button', { name: 'Render' }).click();
      await box.getByRole('img', { name: 'The video' }).waitFor();
      await box.getByText(/6 frames in/).waitFor();
      await screen.quiet();
      await screen.until(() => document.querySelector('.video-image').naturalWidth === 800);
      await t.axe(screen, 'the dialog Save video');
      await t.image(screen, `film-${dark ? 'dark' : 'light'}`);
      const [saved] = await Promise.all([
        screen.page.waitForEvent('download'),
        box.getByRole('button', { name: 'Save file' }).click(),
      ]);
      t.equal(saved.suggestedFilename(), 'rod-video.png', 'name of the video');
      t.check((await readFile(await saved.path())).equals(await fileOf(lab)), 'the saved film is that of the server');
      await box.getByRole('button', { name: 'Close' }).first().click();
      await screen.button('Save video').click();
      t.equal(await box.getByRole('combobox', { name: 'Parameter' }).inputValue(), 'liquid.ior', 'kept parameter');
    }
  },

  'a browser plays the frames of the file': async (t) => {
    const lab = await t.lab(SCENE);
    await lab.post('/api/set', { set: SMALL });
    await lab.post('/api/video', { parameter: 'liquid.ior', from: 1, to: 1.6, frames: 3, fps: 2, format: 'apng' });
    await ended(lab);
    const screen = await t.open(lab);
    const last = await screen.page.evaluate(async () => {
      const reply = await fetch('/api/video/file');
      const decoder = new ImageDecoder({ data: await reply.arrayBuffer(), type: 'image/png' });
      await decoder.tracks.ready;
      const { image } = await decoder.decode({ frameIndex: 2 });
      const canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight);
      canvas.getContext('2d').drawImage(image, 0, 0);
      const blob = await canvas.convertToBlob();
      const text = String.fromCharCode(...new Uint8Array(await blob.arrayBuffer()));
      return { count: decoder.tracks.selectedTrack.frameCount, duration: image.duration, png: btoa(text) };
    });
    t.equal([last.count, last.duration], [3, 500000], 'frames, and microseconds of one');
    await writeFile(join(lab.folder, 'last.png'), Buffer.from(last.png, 'base64'));
    await lab.run('render', SCENE, '-o', 'frame.png', ...sets({ ...SMALL, 'liquid.ior': 1.6 }));
    const [shown, written] = await Promise.all(
      ['last.png', 'frame.png'].map(async (name) => readPng(await readFile(join(lab.folder, name)))),
    );
    t.equal(difference(shown, written), 0, 'share of pixels of the last frame that differ');
  },
};
