// Languages: a pseudo-language, whose texts are in brackets and 40 % longer, finds texts outside the catalogues and
// places where a text does not fit; the menu changes the language and keeps the scene; numbers have the decimal mark.
import { execFileSync } from 'node:child_process';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const texts = join(dirname(fileURLToPath(import.meta.url)), '..', 'source', 'texts.py');
const PANELS = ['lessons', 'params', 'edit', 'pixel', 'bench', 'lens', 'compare', 'slime', 'studies', 'machine'];

/** {text: its translation into the pseudo-language}. */
function pseudo(program) {
  const keys = JSON.parse(execFileSync('python3', ['-B', texts, 'keys', program], { maxBuffer: 1 << 26 }));
  return Object.fromEntries(
    Object.keys(keys).map((key) => [key, `⟦${key}${' ~~~~~'.repeat(Math.round(key.length / 15))}⟧`]),
  );
}

/** The page in a language, as after a choice in its menu. */
async function speak(screen, language, catalogue) {
  if (catalogue)
    await screen.page.route(`**/languages/${language}.json`, (route) => route.fulfill({ json: catalogue }));
  await screen.page.evaluate((code) => localStorage.setItem('cuvette.language', JSON.stringify(code)), language);
  await screen.page.goto('about:blank');
  screen.pending.clear(); // requests of the page before end with it, unreported
  await screen.load();
}

/** Visible texts, titles and labels with words that are neither in brackets nor data of the scene. */
const untranslated = () => {
  const { scene, state } = window.lab;
  const words = (text) => String(text ?? '').match(/[A-Za-zµ][\w-]*/g) ?? [];
  const names = scene.objects.flatMap((each) => Object.values(each));
  const rows = scene.params.flatMap((row) => [row.path, row.range, row.needs, ...[row.value].flat()]);
  const choices = scene.params.flatMap((row) => [...(row.choices ?? []), row.automatic, row.unit]);
  const shapes = scene.shapes.map(({ shape }) => shape);
  const formats =
    'outer inner side surface Cuvette PNG JPEG PDF SVG CSV TSV HTML YAML QR Ctrl Shift GGX BVH nm mm MTF MiB kB dB';
  const listed = [...names, ...rows, ...choices, ...shapes, state.title, state.file, formats].flatMap(words);
  const known = new Set(listed.flatMap((word) => [word, ...word.split('_')]));
  /* The program's notes and what it says of the machine and of studies are English. */
  const program = '.status-message, #live, :is(.panel-machine, .panel-studies) :is(dd, li, .notice)';
  const data = `[translate=no], code, pre, samp, ${program}`;
  const found = new Set();
  const look = (text, node) => {
    let rest = text;
    for (let before = ''; before !== rest;) {
      before = rest;
      rest = rest.replace(/⟦[^⟦⟧]*⟧/g, '');
    }
    const stray = words(rest).filter((word) => word.length > 2 && !known.has(word));
    if (stray.length) found.add(`${node.className?.baseVal ?? node.className}: ${text.trim().slice(0, 90)}`);
  };
  for (const node of document.body.querySelectorAll('*')) {
    if (!node.checkVisibility({ visibilityProperty: true }) || node.closest(data)) continue;
    for (const part of node.childNodes) if (part.nodeType === Node.TEXT_NODE) look(part.data, node);
    for (const name of ['title', 'aria-label', 'placeholder'])
      if (node.hasAttribute(name)) look(node.getAttribute(name), node);
  }
  return [...found];
};

/** Buttons and labels whose text is cut, and what is wider than the window or its panel. */
const clipped = () => {
  const found = new Set();
  const frames = '.button, .tab, .segment, h3, .hint, .fact, .lesson-card, label';
  for (const node of document.querySelectorAll(frames)) {
    if (!node.checkVisibility({ visibilityProperty: true, opacityProperty: true })) continue;
    const { width, left, right } = node.getBoundingClientRect();
    if (width <= 1 || node.closest('.visually-hidden')) continue;
    const style = getComputedStyle(node);
    const cut = style.overflowX !== 'visible' && style.textOverflow !== 'ellipsis' && node.scrollWidth > width + 1;
    const scrolls = node.closest('.table-frame, .tabs, .toolbar, .status, .head');
    if (cut || (!scrolls && (left < -1 || right > innerWidth + 1)))
      found.add(`${node.className}: ${node.textContent.trim().slice(0, 60)}`);
  }
  if (document.scrollingElement.scrollWidth > innerWidth) found.add('the page scrolls sideways');
  return [...found];
};

async function walk(t, screen, where, check) {
  const { page } = screen;
  for (const id of PANELS) {
    await page.evaluate((panel) => window.lab.panels.select(panel), id);
    await screen.quiet();
    t.equal((await page.evaluate(check)).join('\n'), '', `${where}, the panel ${id}`);
  }
}

export const cases = {
  'texts outside the catalogue, and texts that do not fit': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await lab.post('/api/objects', { kind: 'beam', name: 'laser' });
    const screen = await t.open(lab);
    const { page } = screen;
    await speak(screen, 'qps', pseudo(t.program));
    await walk(t, screen, 'texts', untranslated);
    await page.keyboard.press('?');
    t.equal((await page.evaluate(untranslated)).join('\n'), '', 'texts in the list of keys');
    await page.keyboard.press('Escape');
    await walk(t, screen, 'fit in 1366 x 768', clipped);
    await page.setViewportSize({ width: 390, height: 844 });
    await walk(t, screen, 'fit on a telephone', clipped);
  },

  'the menu changes the language, keeps the scene, and numbers have its mark': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const { page } = screen;
    const index = () => page.locator('.param[data-path="liquid.ior"] input[type=text]').first();
    await screen.showPanel('Parameters');
    await index().fill('1,45');
    await index().press('Enter');
    await screen.settled(2);
    t.equal(await page.evaluate(() => window.lab.param('liquid.ior').value), 1.45, 'a decimal comma is read');
    const loaded = page.waitForEvent('load');
    await page.getByLabel('Language').selectOption('de');
    await loaded;
    await page.waitForFunction(() => window.lab?.image);
    await screen.settled();
    t.equal(await page.evaluate(() => document.documentElement.lang), 'de', 'the language of the document');
    t.equal(await index().inputValue(), '1,45', 'the value, with a comma');
    await page.getByRole('button', { name: 'Rückgängig', exact: true }).click();
    await screen.settled(3);
    t.equal(await page.evaluate(() => window.lab.param('liquid.ior').value), 1.33, 'undo still knows the change');
  },
};
