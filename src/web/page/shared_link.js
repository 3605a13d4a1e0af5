/* Scenes in links: the fragment #scene=CODE of the page's address.
 * exports: openLink(lab)        opens the scene of the address, if it has one
 *          openText(lab, link)  opens the scene of a link; undo restores the scene before
 *          copyLink(lab)        copies the address with the current scene */

import { copy } from './ui.js';

export async function openLink(lab) {
  const link = location.hash;
  if (!link.startsWith('#scene=')) return;
  history.replaceState(null, '', location.pathname + location.search); // a reload does not open it again
  await openText(lab, link);
}

export async function openText(lab, link) {
  try {
    await lab.change('/api/open', { link });
    lab.say('The shared scene is shown. Undo restores the scene before.');
  } catch (error) {
    lab.fail(error);
  }
}

export async function copyLink(lab) {
  try {
    const { fragment, code } = await lab.get('/api/link');
    await copy(`${location.origin}/${fragment}${code}`);
    lab.say('Link copied. It holds the whole scene, and opens in any laboratory at that address.');
  } catch (error) {
    lab.fail(error);
  }
}
