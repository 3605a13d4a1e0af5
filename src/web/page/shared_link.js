/* Scenes in links: the fragment #scene=CODE of the page's address; and the scene that a page with the laboratory holds
 * (report/page.h).
 * exports: namesScene()         whether page or address have a scene, or the address names a file (engine_boot.js)
 *          openLink(lab)        opens that scene, and that of the address whenever a link changes only the fragment
 *          openText(lab, link)  opens the scene of a link; undo restores the scene before
 *          copyLink(lab)        copies the address with the current scene */

import { copy } from './ui.js';

const held = document.getElementById('cuvette-scene')?.textContent;
const hasLink = () => location.hash.startsWith('#scene=');
export const namesScene = () => Boolean(held) || hasLink() || new URLSearchParams(location.search).has('scene');

export async function openLink(lab) {
  addEventListener('hashchange', () => openFragment(lab));
  if (held) await openText(lab, `#scene=${held}`);
  else await openFragment(lab);
}

async function openFragment(lab) {
  const link = location.hash;
  if (!hasLink()) return;
  history.replaceState(null, '', location.pathname + location.search); // a reload does not open it again
  await openText(lab, link);
}

/* A page within another one, as in a notebook, has no address: the fragment alone is copied. */
const pageAddress = () => (location.protocol === 'about:' ? '' : new URL(location.pathname, location.href).href);

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
    await copy(`${pageAddress()}${fragment}${code}`);
    lab.say(COPIED[lab.engine.kind]);
  } catch (error) {
    lab.fail(error);
  }
}
