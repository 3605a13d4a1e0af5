/* Files from the server, saved by the browser.
 * exports: saveFile(lab, address, ending)   waits for the final image; the name is the scene's
 *          saveReply(lab, address, name)    any other reply */

import { download } from './ui.js';

export async function saveFile(lab, address, ending) {
  lab.say('Waiting for the final image …');
  try {
    const { blob } = await lab.blob(address);
    download(blob, `${lab.name()}.${ending}`);
    lab.say(`${lab.name()}.${ending} saved.`);
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
