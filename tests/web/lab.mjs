// A laboratory for one test: a temporary folder, `cuvette lab` on it, requests like those of curl, and other commands
// of the program. browser_lab.mjs is the same without a server.
import { spawn, execFile } from 'node:child_process';
import { rmSync } from 'node:fs';
import { cp, mkdtemp, mkdir, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join, dirname } from 'node:path';
import { fileURLToPath } from 'node:url';
import { promisify } from 'node:util';

const here = dirname(fileURLToPath(import.meta.url));
const root = join(here, '..', '..');
const START_LIMIT_MS = 300000;

/** The first match of a pattern in the output of a program; an error with the whole output if the program ends
 * before. */
function firstMatch(child, pattern) {
  return new Promise((resolve, reject) => {
    let text = '';
    const fail = (why) => reject(new Error(`${why}: ${text.trim()}`));
    const late = setTimeout(() => fail('the program printed no address'), START_LIMIT_MS);
    const receive = (piece) => {
      text += piece;
      const match = text.match(pattern);
      if (match) {
        clearTimeout(late);
        resolve(match);
      }
    };
    child.stdout.on('data', receive);
    child.stderr.on('data', receive);
    child.on('exit', (code) => {
      clearTimeout(late);
      fail(`the program ended with ${code}`);
    });
  });
}

/** Running programs and temporary folders, which every exit of this program removes. */
const running = new Set();
process.on('exit', () => {
  for (const { child, folder, state } of running) {
    child?.kill('SIGKILL');
    for (const each of [folder, state]) rmSync(each, { recursive: true, force: true });
  }
});
for (const [signal, code] of [
  ['SIGINT', 130],
  ['SIGTERM', 143],
])
  process.on(signal, () => process.exit(code));

/** The folder of a laboratory with the requests and commands of a test, whatever the engine; a subclass has ask(), the
 * address of the page and home, the address without a scene. */
export class LabFolder {
  /** A folder that contains experiments/scenes as scenes, experiments/hands as hands, tests/web/scenes as tests, and
   * the studies of tests/web/studies. */
  async make(program) {
    this.program = program;
    this.folder = await mkdtemp(join(tmpdir(), 'cuvette-web-'));
    this.state = `${this.folder}-state`; // unsaved scenes, not among those of the user
    running.add(this);
    for (const [from, to] of [
      ['experiments/scenes', 'scenes'],
      ['experiments/hands', 'hands'],
      ['tests/web/scenes', 'tests'],
      ['tests/web/studies', 'studies'],
    ])
      await cp(join(root, from), join(this.folder, to), { recursive: true });
    await mkdir(join(this.folder, 'results'));
  }

  async end() {
    for (const each of [this.folder, this.state]) await rm(each, { recursive: true, force: true });
    running.delete(this);
  }

  async json(method, path, body) {
    const reply = await this.ask(method, path, body);
    const text = new TextDecoder().decode(reply.bytes);
    if (reply.status >= 400) throw new Error(`${method} ${path}: ${reply.status} ${text}`);
    return JSON.parse(text);
  }
  get(path) {
    return this.json('GET', path);
  }
  post(path, body) {
    return this.json('POST', path, body);
  }

  /** The current value of a parameter. */
  async value(path) {
    const scene = await this.get('/api/scene');
    const row = scene.params.find((param) => param.path === path || param.name === path);
    if (!row) throw new Error(`the scene has no ${path}`);
    return row.value;
  }

  /** The output of another command of the program, run in the folder. */
  async run(...words) {
    const { stdout } = await promisify(execFile)(this.program, words, { cwd: this.folder, maxBuffer: 1 << 28 });
    return stdout;
  }
}

export class Lab extends LabFolder {
  /** scene: a file of the folder. */
  static async start(program, scene) {
    const lab = new Lab();
    await lab.make(program);
    await lab.serve(scene);
    return lab;
  }

  /** A page is open: requests of the test do not need it. */
  opened() {}
  takeSpare() {
    return null;
  }

  /** Starts the program; at a free port or, after stop(), at the same port as before. */
  async serve(scene, more = [], env = {}) {
    const port = this.port ? ['--port', String(this.port)] : [];
    this.child = spawn(
      this.program,
      ['lab', ...(scene ? [join(this.folder, scene)] : []), '--no-browser', '--folder', this.folder, ...port, ...more],
      {
        cwd: this.folder,
        stdio: ['ignore', 'pipe', 'pipe'],
        env: { ...process.env, XDG_STATE_HOME: this.state, ...env },
      },
    );
    const [address, number, token] = await firstMatch(this.child, /http:\/\/127\.0\.0\.1:(\d+)\/\?token=([0-9a-f]+)/);
    const origin = `http://127.0.0.1:${number}`;
    Object.assign(this, { address, port: Number(number), token, origin, home: `${origin}/` });
  }

  /** Ends the program: by Ctrl-C, or as a crash does (SIGKILL). */
  async stop(signal = 'SIGINT') {
    const { child } = this;
    if (child.exitCode !== null || child.signalCode !== null) return;
    const ended = new Promise((resolve) => child.once('exit', resolve));
    child.kill(signal);
    await ended;
  }

  async end() {
    await this.stop();
    await super.end();
  }

  /** Status, type and bytes of a reply. */
  async ask(method, path, body) {
    const headers = { Authorization: `Bearer ${this.token}` };
    if (method !== 'GET') headers['Content-Type'] = 'application/json';
    const reply = await fetch(this.origin + path, {
      method,
      headers,
      body: method === 'GET' ? undefined : JSON.stringify(body ?? {}),
    });
    return { status: reply.status, headers: reply.headers, bytes: new Uint8Array(await reply.arrayBuffer()) };
  }
}
