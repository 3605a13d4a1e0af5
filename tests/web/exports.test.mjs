// Exports of the image with what is drawn over it: every file has the lines of the screen, and without the switch the
// engine's own file.
import { readFile } from 'node:fs/promises';
import { readPng } from './png.mjs';
import { difference } from './screen.mjs';

const FOUR = ['x1', 'y1', 'x2', 'y2'];

/** A small scene with a laser, whose first hit is chosen, and a ruler of two points. */
async function bench(t) {
  const lab = await t.lab('scenes/rod.yaml');
  const screen = await t.open(lab);
  await lab.post('/api/set', { set: { 'render.width': 320, 'render.height': 240 } });
  await lab.post('/api/objects', { kind: 'beam' });
  const { generation } = await lab.post('/api/set', {
    set: { 'laser.position': [-2.5, 1.6, -0.4], 'laser.target': [0, 1.4, -0.4], 'laser.lambda_nm': 532 },
  });
  await screen.settled(generation);
  await screen.showPanel('Bench');
  await screen.page.getByRole('button', { name: /^start: vessel/ }).click();
  await screen.page.locator('.layer-bench .bench-normal').waitFor({ state: 'attached' });
  await screen.page.getByLabel('Measure: clicks in the image set points').check();
  for (const x of [100, 180]) {
    const at = await screen.page.evaluate((x) => {
      const { left, top } = window.lab.view.stage.getBoundingClientRect();
      const place = window.lab.view.toScreen(x, 200);
      return { x: left + place.x, y: top + place.y };
    }, x);
    await screen.page.mouse.click(at.x, at.y);
    await screen.page
      .locator('.layer-bench .bench-point')
      .nth(x === 100 ? 0 : 1)
      .waitFor({ state: 'attached' });
  }
  await screen.quiet();
  return { lab, screen };
}

async function save(screen, format, over) {
  await screen.button('Save image').click();
  const box = screen.page.getByRole('dialog', { name: 'Save image' });
  await box.getByRole('radiogroup', { name: 'Format' }).getByText(format, { exact: true }).click();
  await box.getByLabel('With rays, angles and ruler').setChecked(over);
  const [saved] = await Promise.all([
    screen.page.waitForEvent('download'),
    box.getByRole('button', { name: 'Save' }).click(),
  ]);
  return { name: saved.suggestedFilename(), bytes: await readFile(await saved.path()) };
}

/** The lines and texts that are drawn over the image: as numbers of the screen, or of a file's text. */
const onScreen = (screen) =>
  screen.page.evaluate((four) => {
    const layer = document.querySelector('.layer-bench');
    return {
      lines: [...layer.querySelectorAll('line')].map((line) => four.map((name) => Number(line.getAttribute(name)))),
      texts: [...layer.querySelectorAll('text')].map((text) => text.textContent),
    };
  }, FOUR);

/* A document of the page may have no styles of its own, by the page's policy. */
const inFile = (screen, text, type) =>
  screen.page.evaluate(
    ([text, type, four]) => {
      const file = new DOMParser().parseFromString(text, type);
      const drawing = type === 'text/html' ? file.querySelector('svg.seen') : file.documentElement;
      return {
        lines: [...drawing.querySelectorAll('line')].map((line) => four.map((name) => Number(line.getAttribute(name)))),
        texts: [...drawing.querySelectorAll('text')].map((each) => each.textContent),
      };
    },
    [text.replace(/ style="[^"]*"|<style>[^<]*<\/style>/g, ''), type, FOUR],
  );

export const cases = {
  'SVG and HTML have the lines of the screen, PNG and JPEG their pixels': async (t) => {
    const { lab, screen } = await bench(t);
    const seen = await onScreen(screen);
    t.check(seen.lines.length > 8 && seen.texts.length === 3, `${seen.lines.length} lines, ${seen.texts}`);

    const svg = await save(screen, 'SVG', true);
    t.equal(svg.name, 'rod.svg', 'name');
    t.equal(await inFile(screen, String(svg.bytes), 'image/svg+xml'), seen, 'the lines of the SVG file');
    t.check(!/class=|var\(/.test(String(svg.bytes)), 'the SVG file needs no style sheet');
    t.check(String(svg.bytes).includes('mix-blend-mode: plus-lighter'), 'colours of rays add up in it');
    const html = await save(screen, 'HTML', true);
    t.equal(await inFile(screen, String(html.bytes), 'text/html'), seen, 'the lines of the page');

    const plain = await save(screen, 'PNG', false);
    const own = await lab.ask('GET', '/api/image.png?wait=1&scene=1');
    t.check(plain.bytes.equals(Buffer.from(own.bytes)), 'without the switch the file is that of the engine');
    const png = await save(screen, 'PNG', true);
    const [bare, drawn] = [plain, png].map(({ bytes }) => readPng(bytes));
    t.equal([drawn.width, drawn.height], [bare.width, bare.height], 'size');
    const changed = changedPlaces(bare, drawn);
    t.check(changed.length > 300, `${changed.length} pixels have lines`);
    const { scale } = await screen.page.evaluate(() => ({ scale: window.lab.view.scale }));
    const away = changed.filter((place) => farFromAll(place, seen, 4 / scale));
    const texts = await screen.page.evaluate(boxesOfTexts);
    const stray = away.filter(
      ([x, y]) => !texts.some((box) => x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3]),
    );
    t.equal(stray.length, 0, `pixels that differ away from the drawing, such as ${stray[0]}`);
    const jpeg = await save(screen, 'JPEG', true);
    t.equal(await differenceOfJpeg(screen, jpeg.bytes, png.bytes), true, 'the JPEG file shows the same');

    // The scene is in both.
    for (const { bytes } of [plain, png, html]) {
      const { generation } = await lab.post('/api/open', { new: true });
      await screen.settled(generation);
      await drop(screen, bytes, bytes === html.bytes ? 'rod.html' : 'rod.png');
      await screen.until(() => window.lab.object('laser'));
    }
    await t.image(screen, 'exports');
  },

  'the dialog is accessible and remembers its choice': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const nothing = await save(screen, 'PNG', true);
    const own = await lab.ask('GET', '/api/image.png?wait=1&scene=1');
    t.check(nothing.bytes.equals(Buffer.from(own.bytes)), 'with nothing drawn the file is that of the engine');
    await save(screen, 'SVG', false);
    await screen.button('Save image').click();
    const box = screen.page.getByRole('dialog', { name: 'Save image' });
    t.check(await box.getByRole('radio', { name: 'SVG' }).isChecked(), 'the format');
    t.check(!(await box.getByLabel('With rays, angles and ruler').isChecked()), 'the switch');
    await t.axe(screen, 'Save image');
    await t.image(screen, 'save-image');
  },
};

function changedPlaces(a, b) {
  const list = [];
  const step = a.data.length / (a.width * a.height);
  for (let i = 0; i < a.width * a.height; i++)
    if ([0, 1, 2].some((k) => a.data[step * i + k] !== b.data[step * i + k]))
      list.push([(i % a.width) + 0.5, Math.floor(i / a.width) + 0.5]);
  return list;
}

function farFromAll([x, y], { lines }, most) {
  return lines.every(([ax, ay, bx, by]) => {
    const [dx, dy] = [bx - ax, by - ay];
    const t = Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
    return Math.hypot(x - ax - t * dx, y - ay - t * dy) > most;
  });
}

/* In the page: texts and dots in pixels of the image, with their edges. */
function boxesOfTexts() {
  const room = 4 / window.lab.view.scale;
  return [...document.querySelectorAll('.layer-bench :is(text, circle)')].map((node) => {
    const box = node.getBBox();
    return [box.x - room, box.y - room, box.x + box.width + room, box.y + box.height + room];
  });
}

/* Both files, decoded by the browser; few pixels differ by more than JPEG's errors. */
const differenceOfJpeg = (screen, ...files) =>
  screen.page.evaluate(
    async (texts) => {
      const [a, b] = await Promise.all(
        texts.map(async (text) => {
          const bitmap = await createImageBitmap(new Blob([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))]));
          const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
          context.drawImage(bitmap, 0, 0);
          return context.getImageData(0, 0, bitmap.width, bitmap.height).data;
        }),
      );
      let far = 0;
      for (let i = 0; i < a.length; i++) far += Math.abs(a[i] - b[i]) > 60;
      return a.length === b.length && far < a.length / 500;
    },
    files.map((bytes) => bytes.toString('base64')),
  );

const drop = (screen, bytes, name) =>
  screen.page.evaluate(
    ([text, name]) => {
      const data = new DataTransfer();
      data.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
      window.dispatchEvent(new DragEvent('drop', { dataTransfer: data, cancelable: true }));
    },
    [bytes.toString('base64'), name],
  );
