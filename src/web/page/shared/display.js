/* How the page is displayed: theme, large text, and the projector mode (large text, and thick lines in strong colours
 * over the image). They are remembered by the browser.
 * exports:
 *   createDisplay(lab)     sets lab.display: {toggle('text' or 'projector'), open() the dialog}
 *   themeButton(), displayButton(lab)
 *   isDark()               whether the theme is dark
 *   labelSize()            of texts that are drawn over the image, CSS pixels */

import { say, translated } from './language.js';
import { button, checkbox, choice, dialog, element, icon, memory } from './ui.js';

const root = document.documentElement;
const NAMES = { text: 'Large text', projector: 'Projector mode' };
const listeners = new Set();

export const labelSize = () => (root.dataset.text === 'large' ? 20 : 13);

const prefersDark = matchMedia('(prefers-color-scheme: dark)');
export const isDark = () => (root.dataset.theme || (prefersDark.matches ? 'dark' : 'light')) === 'dark';

function setTheme(theme) {
  if (theme) root.dataset.theme = theme;
  else delete root.dataset.theme;
  memory.set('theme', theme || null);
  for (const listener of listeners) listener();
}

const stored = memory.get('theme', null);
if (stored === 'light' || stored === 'dark') root.dataset.theme = stored;
prefersDark.addEventListener('change', () => {
  for (const listener of listeners) listener();
});

export function createDisplay(lab) {
  const on = { text: Boolean(memory.get('display.text')), projector: Boolean(memory.get('display.projector')) };
  const apply = () => {
    if (on.text || on.projector) root.dataset.text = 'large';
    else delete root.dataset.text;
    root.toggleAttribute('data-projector', on.projector);
    lab.view?.redraw();
    for (const listener of listeners) listener();
  };
  const set = (name, value) => {
    on[name] = value;
    memory.set(`display.${name}`, value);
    apply();
  };
  apply();
  lab.display = {
    toggle(name) {
      set(name, !on[name]);
      const what = translated(NAMES[name]);
      lab.say(on[name] ? say('{what} on.', { what }) : say('{what} off.', { what }));
    },
    open: () => openDialog(on, set),
  };
}

function openDialog(on, set) {
  const theme = choice({
    label: 'Theme',
    radios: true,
    choices: [
      ['', 'As the system'],
      ['light', 'Light theme'],
      ['dark', 'Dark theme'],
    ],
    value: root.dataset.theme || '',
    onchange: setTheme,
  });
  const boxes = [
    checkbox('Large text (T)', on.text, (value) => set('text', value)),
    checkbox('Projector mode (P): large text, thick rays and rulers in strong colours', on.projector, (value) =>
      set('projector', value),
    ),
  ];
  dialog({
    title: 'Appearance',
    content: element('div', { class: 'display' }, theme.node, ...boxes.map((b) => b.node)),
  });
}

export const displayButton = (lab) =>
  button('Appearance', () => lab.display.open(), {
    icon: 'screen',
    kind: 'quiet',
    bare: true,
    title: 'Appearance: light or dark, large text (T), projector (P)',
  });

export function themeButton() {
  const face = element('span', { class: 'theme-face' });
  const node = element(
    'button',
    { type: 'button', class: 'button quiet bare', onclick: () => setTheme(isDark() ? 'light' : 'dark') },
    face,
    element('span', { class: 'visually-hidden', text: 'Dark theme' }),
  );
  const show = () => {
    face.replaceChildren(icon(isDark() ? 'sun' : 'moon'));
    node.setAttribute('aria-pressed', String(isDark()));
    node.title = isDark() ? say('Light theme') : say('Dark theme');
  };
  listeners.add(show);
  show();
  return node;
}
