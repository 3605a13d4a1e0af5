/* Scenes in links: the fragment #scene=CODE of the page's address.
 * exports: namesScene()         whether the address has a scene, or names a file (engine_boot.js)
 *          openLink(lab)        opens the scene of the address, now and whenever a link changes only the fragment
 *          openText(lab, link)  opens the scene of a link; undo restores the scene before
 *          copyLink(lab)        copies the address with the current scene */

import { copy } from './ui.js';

const hasLink = () => location.hash.startsWith('#scene=');
export const namesScene = () => hasLink() || new URLSearchParams(location.search).has('scene');

export async function openLink(lab) {
  addEventListener('hashchange', () => openFragment(lab));
  await openFragment(lab);
}

async function openFragment(lab) {
  const link = location.hash;
  if (!hasLink()) return;
  history.replaceState(null, '', location.pathname + location.search); // a reload does not open it again
  await openText(lab, link);
}

const COPIED = {
  server: 'Link copied. It holds the whole scene, and opens in any laboratory at that address.',
  browser: 'Link copied. It holds the whole scene, and opens in any browser that can reach this page.',
};

export async function openText(lab, link) {
  try {
    await lab.change('/api/open', { link });
    lab.panels.reveal();
    lab.say('The shared scene is shown. Undo restores the scene before.');
  } catch (error) {
    lab.fail(error);
  }
}

export async function copyLink(lab) {
  try {
    const { fragment, code } = await lab.get('/api/link');
    const page = new URL(location.pathname, location.href).href;
    await copy(`${page}${fragment}${code}`);
    lab.say(COPIED[lab.engine.kind]);
  } catch (error) {
    lab.fail(error);
  }
}
