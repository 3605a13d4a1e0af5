// A page in the browser, watched: what it prints, what it asks for and from where. Waiting is for conditions alone.
import { readPng } from './png.mjs';

const LIMIT_MS = 20000;

export class Screen {
    /** options: width, height, dark. */
    static async open(browser, lab, options = {}) {
        const screen = new Screen();
        const { width = 1366, height = 768, dark = false } = options;
        screen.lab = lab;
        screen.context = await browser.newContext({ viewport: { width, height }, colorScheme: dark ? 'dark' : 'light', reducedMotion: 'reduce' });
        screen.context.setDefaultTimeout(LIMIT_MS);
        screen.page = await screen.context.newPage();
        screen.troubles = [];
        screen.expected = [];
        screen.watch();
        await screen.load();
        return screen;
    }

    watch() {
        const { page } = this;
        const note = (text) => this.troubles.push(text);
        page.on('console', (message) => {
            if (['error', 'warning'].includes(message.type())) note(`${message.text()} (${message.location().url ?? ''})`);
        });
        page.on('pageerror', (error) => note(`uncaught: ${error.message}`));
        page.on('request', (request) => {
            const url = new URL(request.url());
            if (['data:', 'blob:', 'about:'].includes(url.protocol)) return;
            if (url.origin !== this.lab.origin) note(`a request to ${url.origin}`);
        });
    }

    /** Errors that a case provokes; what matches is no trouble. */
    expect(pattern) { this.expected.push(pattern); }
    get unexpected() { return this.troubles.filter((text) => !this.expected.some((pattern) => pattern.test(text))); }

    async load() {
        await this.page.goto(this.lab.address);
        await this.page.waitForFunction(() => window.lab?.picture);
        await this.settled();
    }

    async close() { await this.context.close(); }

    /** Until what is drawn is the final picture of the newest generation that page and server know of, or of at least this one. */
    async settled(generation = 0) {
        const least = Math.max(generation, (await this.lab.get('/api/state')).generation);
        await this.page.waitForFunction((g) => {
            const { picture, wanted, scene } = window.lab;
            return picture?.final && picture.generation >= Math.max(g, wanted) && scene?.generation >= g;
        }, least);
    }

    /** Until an answer of the page is true; it may use window.lab. */
    until(condition, argument) { return this.page.waitForFunction(condition, argument); }

    /** The picture's canvas as {width, height, data}. */
    async pixels() {
        const { width, height, text } = await this.page.evaluate(() => {
            const canvas = window.lab.view.canvas;
            const { width, height, data } = { width: canvas.width, height: canvas.height, ...{ data: canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data } };
            let text = '';
            for (let i = 0; i < data.length; i += 32768) text += String.fromCharCode(...data.subarray(i, i + 32768));
            return { width, height, text: btoa(text) };
        });
        return { width, height, data: new Uint8ClampedArray(Buffer.from(text, 'base64')) };
    }

    /** The same picture from the server. */
    async served(path = '/api/picture.png?wait=1') { return readPng((await this.lab.ask('GET', path)).bytes); }

    /** Where the pixel's middle lies on the screen. */
    place(x, y) {
        return this.page.evaluate(([px, py]) => {
            const { x, y } = window.lab.view.toScreen(px, py);
            return { x, y };
        }, [x + 0.5, y + 0.5]);
    }

    async clickPixel(x, y) {
        const at = await this.place(x, y);
        await this.page.mouse.click(at.x, at.y);
    }

    button(name) { return this.page.getByRole('button', { name }); }
    tab(name) { return this.page.getByRole('tab', { name }); }
}

/** Share of pixels that differ by more than a level in any channel; Infinity for other sizes. keep(x, y): which count. */
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
