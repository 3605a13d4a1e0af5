/* The bar above the image: offers scenes that a laboratory left unsaved when it ended, one at a time, and reports once
 * that changes cannot be kept.
 * exports: createRescue(root, lab) */

import { ask, button, element, icon, replace } from './ui.js';
import { keepUnsaved } from './unsaved_scene.js';

const when = (time) => new Date(time).toLocaleString(undefined, { dateStyle: 'medium', timeStyle: 'short' });

export function createRescue(root, lab) {
  let shown = ''; /* what the bar tells: it is not drawn again at every change */
  const ours = keepUnsaved(lab);
  let told = false; /* unkept changes are reported once */

  function tell(key, ...parts) {
    if (shown === key) return;
    const focused = root.contains(document.activeElement);
    shown = key;
    root.hidden = !key;
    replace(root, ...parts);
    if (focused) (root.querySelector('button') || document.getElementById('picture'))?.focus();
  }

  async function act(action, id) {
    for (const each of root.querySelectorAll('button')) each.disabled = true;
    try {
      if (id !== ours.offer()?.id) await lab.change('/api/rescue', { action, id });
      else if (action === 'open') await ours.open();
      else ours.drop();
      show(lab.state);
      lab.say(action === 'open' ? 'The rescued scene is shown. Undo restores the scene before.' : 'Discarded.');
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
    tell(
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
    tell(
      'unkept',
      icon('warning'),
      element(
        'span',
        { class: 'rescue-words', role: 'status' },
        element('strong', { text: 'Unsaved changes would be lost in a crash: ' }),
        [[file, error].filter(Boolean).join(': '), remedy].filter(Boolean).join('; '),
      ),
      button('Close', () => tell(''), { small: true }),
    );
    told = true;
  }

  lab.on('restarted', () => {
    told = false;
  });
  lab.on('state', show);

  function show({ rescued = [], unkept }) {
    const offers = [...rescued, ours.offer()].filter(Boolean);
    if (offers.length) offer(offers[0], offers.length - 1);
    else if (unkept && !told) report(unkept);
    else if (shown !== 'unkept' || !unkept) tell('');
  }
}
