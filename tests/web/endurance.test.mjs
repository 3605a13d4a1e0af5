// Endurance of the server: after many requests and event streams it has the descriptors and the memory that it had
// before, strangers who hold connections delay neither the owner nor the tabs, and no program's arguments hold the
// token.
// ENDURANCE=1: 10 000 requests and 300 streams instead of 1000 and 60.
import { spawn } from 'node:child_process';
import { chmod, mkdir, readdir, readFile, writeFile } from 'node:fs/promises';
import { Agent, request } from 'node:http';
import { connect } from 'node:net';
import { join } from 'node:path';

const LONG = Boolean(process.env.ENDURANCE);
const [REQUESTS, STREAMS] = LONG ? [10000, 300] : [1000, 60];
const AT_ONCE = 8; // requests
const WAVE = 30; // streams; the server accepts 48
/** Memory grows to a plateau of about 70 MiB within 15 000 requests, since each connection's thread has an arena of the
 * allocator; a further 15 000 add less than 1 MiB. The long run starts there, and streams use more threads. */
const FIRST = LONG ? 14000 : 400;
const KEPT_KIB = 16384;
const SETTLE_MS = 300000;
const STRANGERS = 128;

const pause = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

/** Descriptors, threads and resident memory of a process. */
async function usage(pid) {
  const status = await readFile(`/proc/${pid}/status`, 'utf8');
  const number = (name) => Number(status.match(new RegExp(`^${name}:\\s+(\\d+)`, 'm'))[1]);
  return { files: (await readdir(`/proc/${pid}/fd`)).length, threads: number('Threads'), kib: number('VmRSS') };
}

/** The usage once it has no more descriptors and threads than before, or at the end of the wait. */
async function settled(pid, before) {
  const end = Date.now() + SETTLE_MS;
  let now = await usage(pid);
  while (Date.now() < end && (now.files > before.files || now.threads > before.threads)) {
    await pause(100);
    now = await usage(pid);
  }
  return now;
}

/** One request over an agent's connections: its status, when the reply is complete. */
function ask(lab, agent, { method = 'GET', path, body, token = lab.token }) {
  const headers = { Authorization: `Bearer ${token}`, 'Content-Type': 'application/json' };
  return new Promise((resolve, reject) => {
    const sent = request({ host: '127.0.0.1', port: lab.port, path, method, headers, agent }, (reply) => {
      reply.resume();
      reply.on('end', () => resolve(reply.statusCode));
    });
    sent.on('error', reject);
    sent.end(body && JSON.stringify(body));
  });
}

/** What a page requests, and mistakes. */
const QUESTIONS = [
  [200, { path: '/api/state' }],
  [200, { path: '/api/scene' }],
  [200, { path: '/api/image.jpg?quick=1' }],
  [200, { path: '/api/trace?x=330&y=420' }],
  [200, { path: '/' }],
  [200, { path: '/api/studies' }],
  [200, { path: '/api/files' }],
  [200, { path: '/api/beams' }],
  [200, { path: '/api/link' }],
  [404, { path: '/api/nothing' }],
  [401, { path: '/api/state', token: 'wrong' }],
  [400, { method: 'POST', path: '/api/set', body: { set: { 'liquid.ior': -1 } } }],
  [200, { method: 'POST', path: '/api/set', body: { set: { 'liquid.ior': 1.4 }, gesture: 'endurance' } }],
];

/** The wrong replies of that many requests, in turn, several at once. */
async function many(lab, count) {
  const agent = new Agent({ keepAlive: true, maxSockets: AT_ONCE });
  const wrong = [];
  let next = 0;
  const work = async () => {
    while (next < count) {
      const [expected, question] = QUESTIONS[next++ % QUESTIONS.length];
      const status = await ask(lab, agent, question);
      if (status !== expected) wrong.push(`${question.path}: ${status}`);
    }
  };
  await Promise.all(Array.from({ length: AT_ONCE }, work));
  agent.destroy();
  return wrong;
}

/** Opens a stream, and closes it after its first event, which a change causes. */
function stream(lab) {
  let opened;
  const open = new Promise((resolve) => (opened = resolve));
  const ended = new Promise((resolve, reject) => {
    const headers = { Authorization: `Bearer ${lab.token}` };
    const sent = request({ host: '127.0.0.1', port: lab.port, path: '/api/events', headers, agent: false }, (reply) => {
      opened(reply.statusCode);
      reply.on('data', (piece) => {
        if (!piece.toString().includes('event: state')) return;
        sent.destroy();
        resolve();
      });
      reply.on('error', () => resolve());
    });
    sent.on('error', reject);
    sent.end();
  });
  return { open, ended };
}

async function streams(lab, count) {
  const codes = [];
  for (let done = 0; done < count; done += WAVE) {
    const wave = Array.from({ length: Math.min(WAVE, count - done) }, () => stream(lab));
    codes.push(...(await Promise.all(wave.map(({ open }) => open))));
    await lab.post('/api/set', { set: { 'liquid.ior': 1.3 + (done % 7) / 100 }, gesture: 'endurance' });
    await Promise.all(wave.map(({ ended }) => ended));
  }
  return codes;
}

/** Waits until nothing is rendered, so that memory is compared in the same state. */
const idle = (lab) => lab.ask('GET', '/api/image.png?wait=1');

export const cases = {
  [`${REQUESTS} requests and ${STREAMS} streams leave nothing behind`]: async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const { pid } = lab.child;
    // The first requests load what later ones share: caches, and the allocator's arena of each thread.
    await many(lab, FIRST);
    await streams(lab, WAVE);
    await idle(lab);
    await pause(11000); // connections of fetch are closed when they are idle for 10 s
    const before = await usage(pid);
    const began = Date.now();
    t.none(await many(lab, REQUESTS), 'wrong replies');
    const codes = await streams(lab, STREAMS);
    t.equal([codes.length, codes.every((code) => code === 200)], [STREAMS, true], 'streams that opened');
    const took = (Date.now() - began) / 1000;
    await idle(lab);
    await pause(11000);
    const after = await settled(pid, before);
    t.equal([after.files, after.threads], [before.files, before.threads], 'descriptors and threads');
    t.less(after.kib - before.kib, KEPT_KIB, 'KiB more of memory');
    if (LONG)
      console.log(
        `      ${REQUESTS} requests and ${STREAMS} streams in ${took.toFixed(1)} s: descriptors ${before.files} and ` +
          `${after.files}, threads ${before.threads} and ${after.threads}, VmRSS ${before.kib} and ${after.kib} KiB`,
      );
  },

  'strangers delay neither the owner nor the tabs of two browsers': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const { pid } = lab.child;
    // A scene with changes is kept in a file, which stays open and locked.
    await lab.post('/api/set', { set: { 'liquid.ior': 1.4 } });
    await pause(1500);
    const before = await usage(pid);
    const screens = [await t.open(lab), await t.open(lab)];
    const tabs = screens.map((screen) => screen.page);
    while (tabs.length < 10) {
      const { context } = screens[tabs.length % 2];
      const page = await context.newPage();
      await page.goto(lab.address);
      await page.waitForFunction(() => window.lab?.image?.final);
      tabs.push(page);
    }
    const held = [];
    for (let i = 0; i < STRANGERS; i++) {
      const socket = connect(lab.port, '127.0.0.1');
      socket.on('error', () => {});
      held.push(socket);
      if (i % 2) socket.write('GET /api/state HTTP/1.1\r\n');
    }
    await Promise.all(
      held.map((socket) => new Promise((done) => (socket.connecting ? socket.once('connect', done) : done()))),
    );
    // A connection of its own each time, as of curl.
    for (let i = 0; i < 10; i++)
      t.equal(await ask(lab, new Agent(), { path: '/api/state' }), 200, 'the owner is served');

    // A change in one tab is seen in the nine others.
    await tabs[0].bringToFront();
    const { generation } = await lab.get('/api/state');
    await screens[0].setNumber('liquid.ior', 1.47);
    for (const page of tabs)
      await page.waitForFunction(
        (old) =>
          window.lab.image.final && window.lab.image.generation > old && window.lab.param('liquid.ior').value === 1.47,
        generation,
      );
    t.check(true, 'ten tabs follow');
    for (const socket of held) socket.destroy();
    for (const screen of screens) await screen.close();
    const after = await settled(pid, before);
    t.check(after.files <= before.files, `descriptors: ${before.files} before, ${after.files} after all left`);
    if (LONG)
      console.log(`      the owner's slowest reply among ${STRANGERS} strangers: ${Math.max(...times).toFixed(1)} ms`);
  },

  'the token is in no arguments of a program': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const bin = join(lab.folder, 'bin');
    await mkdir(bin);
    // Instead of a browser: a program that stays, so that its arguments can be read.
    await writeFile(join(bin, 'xdg-open'), '#!/bin/sh\necho "$1" >"$HERE/opened"\nexec sleep 30\n');
    await chmod(join(bin, 'xdg-open'), 0o755);
    const child = spawn(t.program, ['lab', '--folder', lab.folder], {
      cwd: lab.folder,
      env: { ...process.env, PATH: `${bin}:${process.env.PATH}`, HERE: lab.folder, DISPLAY: ':0' },
      stdio: ['ignore', 'pipe', 'pipe'],
      detached: true,
    });
    try {
      let said = '';
      child.stdout.on('data', (piece) => (said += piece));
      const end = Date.now() + SETTLE_MS;
      const opened = () => readFile(join(lab.folder, 'opened'), 'utf8').catch(() => '');
      while (Date.now() < end && !((await opened()) && said.includes('token='))) await pause(50);
      const [token] = said.match(/[0-9a-f]{32}/) || [''];
      t.equal(token.length, 32, 'length of the printed token');
      t.check(await opened(), 'the browser was started');
      const found = [];
      let read = 0;
      for (const pid of (await readdir('/proc')).filter((name) => /^\d+$/.test(name))) {
        const words = await readFile(`/proc/${pid}/cmdline`, 'utf8').catch(() => '');
        read += words.includes(join(bin, 'xdg-open')) || words.startsWith('sleep') ? 1 : 0;
        for (const each of [token, lab.token]) if (words.includes(each)) found.push(`${pid}: ${words}`);
      }
      t.more(read, 0, 'the process in place of the browser is among those read');
      t.none(found, 'processes with the token in their arguments');
    } finally {
      process.kill(-child.pid, 'SIGTERM');
    }
  },
};
