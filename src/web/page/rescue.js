/* The bar above the image: offers scenes that a laboratory left unsaved when it ended, one at a time, and reports once
 * that changes cannot be kept.
 * exports: createRescue(root, lab) */

import { ask, button, element, icon, replace } from './shared/ui.js';

/* --- the unsaved scene of a laboratory in the browser, which ends with its page ---
 * The scene is kept as the code of a link, and the next page of the tab offers it. A scene that reads files has no such
 * code and is not kept. */

const KEY = 'cuvette.unsaved';
const REST_MS = 1000; /* the scene is kept when it has not changed for this time */

/* Storage may be forbidden or full: then nothing is kept. */
function stored(act) {
  try {
    return act(sessionStorage);
  } catch {
    return null;
  }
}

function keepUnsaved(lab) {
  let found = null; /* the scene of the page before */
  let timer = 0;
  if (lab.engine.kind === 'browser') {
    found = stored((storage) => JSON.parse(storage.getItem(KEY)));
    lab.on('state', () => {
      clearTimeout(timer);
      timer = setTimeout(keep, REST_MS);
    });
  }
  return {
    offer: () => found && { id: KEY, ...found },
    async open() {
      await lab.change('/api/open', { link: `#scene=${found.code}` });
      lab.panels.reveal();
      found = null;
    },
    drop() {
      found = null;
      stored((storage) => storage.removeItem(KEY));
    },
  };

  async function keep() {
    const { saved, unsaved, undo, title, file } = lab.state;
    if (saved && undo) stored((storage) => storage.removeItem(KEY));
    if (!unsaved) return;
    const { code } = await lab.get('/api/link').catch(() => ({}));
    if (code) stored((storage) => storage.setItem(KEY, JSON.stringify({ code, time: Date.now(), title, file })));
  }
}

/* --- the bar --- */

const when = (time) => new Date(time).toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' });

export function createRescue(root, lab) {
  let shown = ''; /* key of the bar's content, which is drawn only if it changes */
  const ours = keepUnsaved(lab);
  let reported = false; /* one report of unkept changes is enough */

  function fill(key, ...parts) {
    if (shown === key) return;
    const focused = root.contains(document.activeElement);
    shown = key;
    root.hidden = !key;
    replace(root, ...parts);
    if (focused) (root.querySelector('button') || document.getElementById('image'))?.focus();
  }

  async function act(action, id) {
    for (const each of root.querySelectorAll('button')) each.disabled = true;
    try {
      if (id !== ours.offer()?.id) await lab.change('/api/rescue', { action, id });
      else if (action === 'open') await ours.open();
      else ours.drop();
      show(lab.state);
      lab.say(action === 'open' ? 'The rescued scene is shown. Undo restores the previous scene.' : 'Discarded.');
    } catch (error) {
      for (const each of root.querySelectorAll('button')) each.disabled = false;
      lab.fail(error);
    }
  }

  async function discard({ id, title }) {
    const name = title || 'the rescued scene';
    if (await ask('Discard', `Discard the unsaved changes of ${name}? They cannot be restored.`, 'Discard', 'danger'))
      await act('discard', id);
  }

  function offer(scene, more) {
    const name = [scene.title || 'Untitled scene', scene.file].filter(Boolean).join(', ');
    fill(
      `${scene.id} ${more}`,
      icon('info'),
      element(
        'span',
        { class: 'rescue-words', role: 'status' },
        element('strong', { text: `An unsaved scene of ${when(scene.time)} was rescued: ` }),
        more ? `${name} (and ${more} more)` : name,
      ),
      element(
        'span',
        { class: 'rescue-buttons' },
        button('Open', () => act('open', scene.id), { kind: 'primary', small: true }),
        button('Discard', () => discard(scene), { small: true }),
      ),
    );
  }

  function report({ file, error, remedy }) {
    fill(
      'unkept',
      icon('warning'),
      element(
        'span',
        { class: 'rescue-words', role: 'status' },
        element('strong', { text: 'Unsaved changes would be lost in a crash: ' }),
        [[file, error].filter(Boolean).join(': '), remedy].filter(Boolean).join('; '),
      ),
      button('Close', () => fill(''), { small: true }),
    );
    reported = true;
  }

  lab.on('restarted', () => {
    reported = false;
  });
  lab.on('state', show);

  function show({ rescued = [], unkept }) {
    const offers = [...rescued, ours.offer()].filter(Boolean);
    if (offers.length) offer(offers[0], offers.length - 1);
    else if (unkept && !reported) report(unkept);
    else if (shown !== 'unkept' || !unkept) fill('');
  }
}
