/* Files of the final image, saved by the browser.
 * exports: saveFile(lab, address, ending)   waits for the image; the name is the scene's */

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
