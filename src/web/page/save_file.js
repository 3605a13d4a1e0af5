/* Files from the server, saved by the browser.
 * exports: saveFile(lab, address, ending, more)   waits for the final image; the name is the scene's
 *                                           more: words for the end of the message that it is saved
 *          saveReply(lab, address, name)    any other reply */

import { download } from './ui.js';

export async function saveFile(lab, address, ending, more = '') {
  lab.say('Waiting for the final image …');
  try {
    const { blob } = await lab.blob(address);
    download(blob, `${lab.name()}.${ending}`);
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
