// A page of the laboratory in the browser, with its console messages and requests. Waits are for conditions, never for
// fixed times.
import { readPng } from './png.mjs';

const LIMIT_MS = 300000; // for one thing to happen; a busy machine does not reach it

export class Screen {
  /** options: width, height, dark; touch: a device with a coarse pointer. */
  static async open(browser, lab, options = {}) {
    const screen = new Screen();
    const { width = 1366, height = 768, dark = false, touch = false } = options;
    screen.lab = lab;
    screen.context = await browser.newContext({
      viewport: { width, height },
      colorScheme: dark ? 'dark' : 'light',
      reducedMotion: 'reduce',
      hasTouch: touch,
      isMobile: touch,
    });
    screen.context.setDefaultTimeout(LIMIT_MS);
    screen.page = await screen.context.newPage();
    lab.opened(screen.page);
    screen.errors = [];
    screen.expected = [];
    screen.pending = new Set();
    screen.idle = [];
    screen.watch();
    await screen.load();
    return screen;
  }

  /** Gives an open page another size or theme. */
  async adapt({ width = 1366, height = 768, dark = false, touch = false } = {}) {
    if (touch) throw new Error('a page cannot become one of a touch screen: open it before the first request');
    await this.page.setViewportSize({ width, height });
    await this.page.emulateMedia({ colorScheme: dark ? 'dark' : 'light', reducedMotion: 'reduce' });
  }

  watch() {
    const { page } = this;
    const note = (text) => this.errors.push(text);
    page.on('console', (message) => {
      if (['error', 'warning'].includes(message.type())) note(`${message.text()} (${message.location().url ?? ''})`);
    });
    page.on('pageerror', (error) => note(`uncaught: ${error.message}`));
    page.on('request', (request) => {
      const url = new URL(request.url());
      if (['data:', 'blob:', 'about:'].includes(url.protocol)) return;
      if (url.origin !== this.lab.origin) note(`a request to ${url.origin}`);
      if (url.pathname !== '/api/events') this.pending.add(request);
    });
    for (const end of ['requestfinished', 'requestfailed'])
      page.on(end, (request) => {
        this.pending.delete(request);
        if (this.pending.size === 0) for (const wake of this.idle.splice(0)) wake();
      });
  }

  /** Records the paths that the page asks of its engine from now on: a list that grows. A counted path has been asked
   * when the test sees what came of it. */
  async asked() {
    const list = [];
    this.recorders ??= this.page
      .exposeFunction('recordAsked', (path) => this.record(path))
      .then(() =>
        this.page.evaluate(() => {
          const { engine } = window.lab;
          const { fetch } = engine;
          engine.fetch = (path, options) => {
            window.recordAsked(path);
            return fetch(path, options);
          };
        }),
      );
    await this.recorders;
    this.record = (path) => list.push(path);
    return list;
  }

  /** Permits errors that a case provokes. */
  expect(pattern) {
    this.expected.push(pattern);
  }
  get unexpected() {
    return this.errors.filter((text) => !this.expected.some((pattern) => pattern.test(text)));
  }

  async load() {
    const broken = new Promise((_, reject) => this.page.once('pageerror', reject)); // sooner than by a time limit
    await this.page.goto(this.lab.address);
    await Promise.race([this.page.waitForFunction(() => window.lab?.image), broken]);
    broken.catch(() => {}); // later errors are found by watch
    await this.settled();
  }

  async close() {
    await this.context.close();
  }

  /** Waits until the displayed image is the final one of the newest generation known to page and server, or of at
   * least this one. */
  async settled(generation = 0) {
    const least = Math.max(generation, (await this.lab.get('/api/state')).generation);
    await this.page.waitForFunction((g) => {
      const { image, newestGeneration, scene, change } = window.lab;
      const newest = image?.final && image.generation >= Math.max(g, newestGeneration);
      return change.idle() && newest && scene?.generation >= g;
    }, least);
  }

  /** Waits until no request is pending except the event stream, and the latest image is drawn. */
  async quiet() {
    await this.until(() => window.lab.change.idle() && window.lab.engine.idle()); // changes wait for images
    do {
      // a reply may trigger requests that waited for it
      if (this.pending.size) await new Promise((resolve) => this.idle.push(resolve));
      await this.page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
    } while (this.pending.size);
  }

  /** Waits until a condition in the page is true; it may use window.lab. */
  until(condition, argument) {
    return this.page.waitForFunction(condition, argument);
  }

  /** The canvas pixels of the image as {width, height, data}: at actual size, so that one image pixel is one canvas
   * pixel. */
  async pixels() {
    const { width, height, scale, text } = await this.page.evaluate(async () => {
      const { view } = window.lab;
      await new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)));
      const canvas = view.stage.querySelector('canvas');
      const { width, height, scale } = view;
      const corner = view.toScreen(0, 0);
      const copy = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true });
      copy.drawImage(canvas, -Math.round(corner.x), -Math.round(corner.y));
      const shown = copy.getImageData(0, 0, width, height).data;
      let text = '';
      for (let i = 0; i < shown.length; i += 32768) text += String.fromCharCode(...shown.subarray(i, i + 32768));
      return { width, height, scale, text: btoa(text) };
    });
    if (Math.abs(scale - 1) > 1e-6) throw new Error(`the image is shown at ${scale} of its size; actualSize() first`);
    return { width, height, data: new Uint8ClampedArray(Buffer.from(text, 'base64')) };
  }

  /** The image as displayed, with everything drawn over it. */
  async displayed() {
    const { width, height } = await this.page.evaluate(() => ({
      width: window.lab.view.width,
      height: window.lab.view.height,
    }));
    const corner = await this.place(0, 0);
    return readPng(await this.page.screenshot({ clip: { ...corner, width, height } }));
  }

  /** Shows the image at actual size, by its key. */
  async actualSize() {
    await this.stage.focus();
    await this.page.keyboard.press('1');
    await this.until(() => Math.abs(window.lab.view.scale - 1) < 1e-6);
  }

  /** The same image from the server. */
  async served(path = '/api/image.png?wait=1') {
    return readPng((await this.lab.ask('GET', path)).bytes);
  }

  /** The window position of an image point in image pixels. */
  place(x, y) {
    return this.page.evaluate(
      ([px, py]) => {
        const { view } = window.lab;
        const box = view.stage.getBoundingClientRect();
        const at = view.toScreen(px, py);
        return { x: box.left + view.stage.clientLeft + at.x, y: box.top + view.stage.clientTop + at.y };
      },
      [x, y],
    );
  }

  async clickPixel(x, y) {
    const at = await this.place(x + 0.5, y + 0.5);
    await this.page.mouse.click(at.x, at.y);
  }

  /** Presses at one image point, moves to another in steps, and releases. */
  async drag(from, to, steps = 12) {
    const [a, b] = [await this.place(from.x, from.y), await this.place(to.x, to.y)];
    await this.page.mouse.move(a.x, a.y);
    await this.page.mouse.down();
    await this.page.mouse.move(b.x, b.y, { steps });
    await this.page.mouse.up();
  }

  get stage() {
    return this.page.locator('#image');
  }

  /** Chooses a pointer tool in the toolbar over the image. The radio buttons are small, so the click is on their
   * label. */
  async chooseTool(name) {
    const radio = this.page.getByRole('radiogroup', { name: 'Pointer tool' }).getByRole('radio', { name, exact: true });
    await radio.locator('xpath=ancestor::label').click();
    await this.until((input) => input.checked, await radio.elementHandle());
  }

  /** The titles of all panels, in the order of the tabs. */
  panelNames() {
    return this.page.evaluate(() =>
      [...document.querySelectorAll('.panel-frame:not(:has(.tabs)) > h2')].map((title) => title.textContent),
    );
  }

  /** Chooses a panel, by the tab of its group first where it has one. */
  async showPanel(name) {
    const group = await this.page
      .locator('.inner > .tab', { hasText: name })
      .evaluateAll(([tab]) => tab?.closest('[role=tabpanel]').getAttribute('aria-labelledby'));
    if (group) await this.page.locator(`#${group}`).click();
    await this.tab(name).click();
    await this.page.getByRole('tabpanel', { name }).waitFor();
  }

  /** A parameter's slider in the panel Parameters. */
  async paramSlider(path) {
    await this.showPanel('Parameters');
    return this.page.getByRole('slider', { name: path.replaceAll(/[._]/g, ' '), exact: true }).first();
  }

  /** Types a value into a parameter's number field and waits until the scene has it and is drawn. */
  async setNumber(path, value) {
    await this.showPanel('Parameters');
    const field = this.page
      .getByRole('spinbutton', { name: `${path.replaceAll(/[._]/g, ' ')}, number`, exact: true })
      .first();
    const { generation } = await this.lab.get('/api/state');
    await field.fill(String(value));
    await field.press('Enter');
    await this.until((g) => window.lab.newestGeneration > g, generation);
    await this.settled(generation + 1);
  }

  button(name, exact = false) {
    return this.page.getByRole('button', { name, exact });
  }
  tab(name) {
    return this.page.getByRole('tab', { name });
  }
}

/** The fraction of pixels that differ by more than one level in any channel; Infinity for different sizes. keep(x, y):
 * which pixels count. */
export function difference(a, b, keep = () => true) {
  if (a.width !== b.width || a.height !== b.height) return Infinity;
  let [all, other] = [0, 0];
  for (let y = 0; y < a.height; y++)
    for (let x = 0; x < a.width; x++) {
      if (!keep(x, y)) continue;
      const i = (y * a.width + x) * 4;
      all++;
      if ([0, 1, 2].some((c) => Math.abs(a.data[i + c] - b.data[i + c]) > 1)) other++;
    }
  return other / all;
}
