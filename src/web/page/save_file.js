/* Files from the laboratory, saved by the browser.
 * exports: saveFile(lab, address, ending, more)   waits for the final image; the name is the scene's
 *                                           more: words for the end of the message that it is saved
 *          savePage(lab, more)              the image as a page, with the laboratory where that can be had
 *          saveReply(lab, address, name)    any other reply */

import { PLACE_FOR_LABORATORY, withLaboratory } from './live_page.js';
import { download } from './ui.js';

export async function savePage(lab, more) {
  if (lab.engine.kind === 'server') await saveFile(lab, '/api/page.html', 'html', more);
  else await saveFile(lab, `/api/page.html?${PLACE_FOR_LABORATORY}`, 'html', more, withLaboratory);
}

export async function saveFile(lab, address, ending, more = '', complete = (blob) => blob) {
  lab.say('Waiting for the final image …');
  try {
    const { blob } = await lab.blob(address);
    download(await complete(blob), `${lab.name()}.${ending}`);
    lab.say(`${lab.name()}.${ending} saved${more}.`);
  } catch (error) {
    lab.fail(error);
  }
}

export async function saveReply(lab, address, name) {
  try {
    const { blob } = await lab.blob(address);
    download(blob, name);
    lab.say(`${name} saved.`);
  } catch (error) {
    lab.fail(error);
  }
}
