/* Files from the laboratory, saved by the browser.
 * exports:
 *   saveFile(lab, address, ending, more)   waits for the final image; the name is the scene's; more: the end of the
 *                                          message 'NAME saved'
 *   savePage(lab, more)                    the image as a page, with the laboratory if the page has its text
 *   saveReply(lab, address, name)          any other reply */

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

/* --- pages with the laboratory, if the engine runs in this page ---
 * The engine leaves a place for the laboratory in the page (report/page.h). The site supplies the text of
 * laboratory.html (src/web/site/boot.js); without this text the page is saved without the laboratory. */

const PLACE_FOR_LABORATORY = 'live=empty';
const PLACE = 'id="cuvette-live">';

const base64 = (blob) =>
  new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result.split(',')[1]);
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(blob);
  });

async function withLaboratory(blob) {
  const [before, after] = (await blob.text()).split(PLACE, 2);
  const laboratory = after === undefined ? null : await globalThis.cuvetteDocument?.().catch(() => null);
  if (!laboratory) return blob;
  const packed = new Blob([laboratory]).stream().pipeThrough(new CompressionStream('deflate'));
  const code = await base64(await new Response(packed).blob());
  return new Blob([before, PLACE, code, after], { type: blob.type });
}
