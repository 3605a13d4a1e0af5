/* The bar above the image: offers scenes that a laboratory left unsaved when it ended, one at a time, and reports once
 * that changes cannot be kept.
 * exports: createRescue(root, lab) */

import { say } from './shared/language.js';
import { returned, session } from './shared/address.js';
import { ask, button, element, icon, replace } from './shared/ui.js';

/* --- the scene of a laboratory in the browser, which ends with its page ---
 * The scene is kept as the code of a link. After a reload, Back or Forward it is shown again; another page of the tab
 * offers it if it was not saved. A scene that reads files has no such code and is not kept. */

const KEY = 'scene';
const REST_MS = 1000; /* the scene is kept when it has not changed for this time */

function keepScene(lab) {
  let found = null; /* the scene of the page before */
  let timer = 0;
  if (lab.engine.kind === 'browser') {
    found = session.get(KEY);
    lab.on('connection', (value) => {
      const last = session.get(KEY);
      if (value === 'lost' && last) session.set(KEY, { ...last, stopped: true });
    });
    lab.on('state', () => {
      clearTimeout(timer);
      timer = setTimeout(keep, REST_MS);
    });
  }
  const opensItself = () => Boolean(found) && returned() && !found.stopped; /* it may be what stopped the engine */
  return {
    offer: () => found?.unsaved && !opensItself() && { id: KEY, ...found },
    opensItself,
    /* send: lab.change, or lab.post, after which the address goes on to name what it names. */
    async open(send = lab.change) {
      const { code } = found;
      found = null;
      await send('/api/open', { link: `#scene=${code}` });
      lab.panels?.reveal();
    },
    drop() {
      found = null;
      session.drop(KEY);
    },
    keep: () => lab.engine.kind === 'server' || keep().then((kept) => kept || !lab.state.unsaved),
  };

  /* The scene with which the page began needs no copy. Returns whether the copy is there. */
  async function keep() {
    const { undo, unsaved, title, file, generation } = lab.state;
    const { code } = undo ? await lab.get('/api/link').catch(() => ({})) : {};
    if (generation !== lab.state.generation) return false;
    if (code) session.set(KEY, { code, time: Date.now(), title, file, unsaved });
    else session.drop(KEY);
    return Boolean(code);
  }
}

/* --- the bar --- */

const when = (time) =>
  new Date(time).toLocaleString(document.documentElement.lang, { dateStyle: 'medium', timeStyle: 'short' });

export function createRescue(root, lab) {
  let shown = ''; /* key of the bar's content, which is drawn only if it changes */
  const ours = keepScene(lab);
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
    const question = title
      ? say('Discard the unsaved changes of {title}? They cannot be restored.', { title })
      : say('Discard the unsaved changes of the rescued scene? They cannot be restored.');
    if (await ask('Discard', question, 'Discard', 'danger')) await act('discard', id);
  }

  function offer(scene, more) {
    const name = [scene.title || say('Untitled scene'), scene.file].filter(Boolean).join(', ');
    fill(
      `${scene.id} ${more}`,
      icon('info'),
      element(
        'span',
        { class: 'rescue-words', role: 'status' },
        element('strong', { text: `${say('An unsaved scene of {time} was rescued:', { time: when(scene.time) })} ` }),
        more ? say('{name} (and {n} more)', { name, n: more }) : name,
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

  lab.rescue = { hasScene, keep: ours.keep };
  lab.on('restarted', () => {
    reported = false;
  });
  lab.on('state', show);

  /* Whether the scene that the page showed before a reload is there: the program still has it, or it is opened again.
   * The first call of two opens it. */
  let opening = null;
  function hasScene() {
    opening ??= (async () => {
      if (lab.engine.kind !== 'browser') return Boolean((await lab.get('/api/state')).undo);
      if (!ours.opensItself()) return false;
      await ours.open(lab.post);
      return true;
    })().catch((error) => {
      lab.fail(error);
      return false;
    });
    return opening;
  }

  function show({ rescued = [], unkept }) {
    const offers = [...rescued, ours.offer()].filter(Boolean);
    if (offers.length) offer(offers[0], offers.length - 1);
    else if (unkept && !reported) report(unkept);
    else if (shown !== 'unkept' || !unkept) fill('');
  }
}
