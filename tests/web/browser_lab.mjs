// A laboratory for one test without a server: the page with its engine in the browser, from a server of plain files.
// Requests go through the engine of the page that was opened last; without one, a page is opened for them, which the
// test then gets as its screen.
import { readdir, readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { LabFolder } from './lab.mjs';
import { serveSite } from './site_server.mjs';

/** The folder as the page gets it: {NAME: text or {base64}}. */
async function packed(folder, prefix = '') {
  const files = {};
  for (const entry of await readdir(folder, { recursive: true, withFileTypes: true })) {
    if (!entry.isFile()) continue;
    const path = join(entry.path, entry.name);
    const bytes = await readFile(path);
    const text = bytes.toString('utf8');
    const name = prefix + path.slice(folder.length + 1);
    files[name] = Buffer.from(text, 'utf8').equals(bytes) ? text : { base64: bytes.toString('base64') };
  }
  return files;
}

export class BrowserLab extends LabFolder {
  /** site: of site.mjs; open(lab): opens a page. */
  static async start(program, scene, site, open) {
    const lab = new BrowserLab();
    await lab.make(program);
    lab.open = open;
    lab.pages = [];
    lab.server = await serveSite(site.folder, {
      ...site.made,
      [site.files]: async () =>
        JSON.stringify({
          ...(await packed(site.lessons, 'lessons/')),
          ...(await packed(lab.folder)),
        }),
    });
    lab.origin = lab.server.origin;
    lab.home = `${lab.origin}${site.lab}`;
    lab.address = scene ? `${lab.home}?scene=${encodeURIComponent(scene)}` : lab.home;
    return lab;
  }

  opened(page) {
    this.pages.unshift(page);
    page.once('close', () => this.pages.splice(this.pages.indexOf(page), 1));
  }

  async page() {
    if (!this.pages.length) {
      const screen = await this.open(this);
      this.spare = screen;
    }
    return this.pages[0];
  }

  /** The page that was opened for requests, as the screen of the test: another one would have another scene. */
  async takeSpare(how) {
    const { spare } = this;
    this.spare = null;
    await spare?.adapt(how);
    return spare;
  }

  /** Status, type and bytes of a reply. */
  async ask(method, path, body) {
    const page = await this.page();
    const { status, headers, text } = await page.evaluate(
      async ([method, path, body]) => {
        const reply = await window.lab.engine.fetch(path, { method, body });
        const bytes = new Uint8Array(await reply.arrayBuffer());
        let text = '';
        for (let i = 0; i < bytes.length; i += 32768) text += String.fromCharCode(...bytes.subarray(i, i + 32768));
        return { status: reply.status, headers: [...reply.headers], text: btoa(text) };
      },
      [method, path, method === 'GET' ? null : JSON.stringify(body ?? {})],
    );
    return { status, headers: new Headers(headers), bytes: new Uint8Array(Buffer.from(text, 'base64')) };
  }

  async end() {
    await this.server.close();
    await super.end();
  }
}
