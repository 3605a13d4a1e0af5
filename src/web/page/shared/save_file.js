/* Files from the laboratory, saved by the browser.
 * exports:
 *   saveFile(lab, address, ending, refusal)   waits for the final image; the name is the scene's; refusal: why the file
 *                                          does not hold the scene
 *   savePage(lab, refusal, drawing)        the image as a page, with the laboratory if the page has its text; drawing:
 *                                          over the image, in place of the page's rays (snapshot.js)
 *   saveReply(lab, address, name)          any other reply */

import { say } from './language.js';
import { dataAddress, textOf } from './snapshot.js';
import { download } from './ui.js';

export async function savePage(lab, refusal, drawing = null) {
  const server = lab.engine.kind === 'server';
  await saveFile(lab, `/api/page.html${server ? '' : `?${PLACE_FOR_LABORATORY}`}`, 'html', refusal, async (blob) => {
    const page = server ? blob : await withLaboratory(blob);
    return drawing ? withDrawing(page, drawing) : page;
  });
}

/* The page's own lines are links to the rows of its table: they stay, unseen, and the chosen one is shown. */
const UNSEEN = '<style>.seen~svg{opacity:0}.seen~svg:has(:target){opacity:1}</style>';

async function withDrawing(blob, drawing) {
  const text = await blob.text();
  const at = text.indexOf('<svg', text.indexOf('<div class="stage"'));
  drawing.setAttribute('class', 'seen');
  Object.assign(drawing.style, { position: 'absolute', inset: '0' });
  return new Blob([text.slice(0, at), UNSEEN, textOf(drawing), text.slice(at)], { type: blob.type });
}

export async function saveFile(lab, address, ending, refusal = '', complete = (blob) => blob) {
  lab.say('Waiting for the final image …');
  try {
    const { blob } = await lab.blob(address);
    download(await complete(blob), `${lab.name()}.${ending}`);
    const name = `${lab.name()}.${ending}`;
    lab.say(
      refusal ? say('{name} saved without the scene: {why}.', { name, why: refusal }) : say('{name} saved.', { name }),
    );
  } catch (error) {
    lab.fail(error);
  }
}

export async function saveReply(lab, address, name) {
  try {
    const { blob } = await lab.blob(address);
    download(blob, name);
    lab.say(say('{name} saved.', { name }));
  } catch (error) {
    lab.fail(error);
  }
}

/* --- pages with the laboratory, if the engine runs in this page ---
 * The engine leaves a place for the laboratory in the page (report/page.h). The site supplies the text of
 * laboratory.html (src/web/site/boot.js); without this text the page is saved without the laboratory. */

const PLACE_FOR_LABORATORY = 'live=empty';
const PLACE = 'id="cuvette-live">';

async function withLaboratory(blob) {
  const [before, after] = (await blob.text()).split(PLACE, 2);
  const laboratory = after === undefined ? null : await globalThis.cuvetteDocument?.().catch(() => null);
  if (!laboratory) return blob;
  const packed = new Blob([laboratory]).stream().pipeThrough(new CompressionStream('deflate'));
  const [, code] = (await dataAddress(await new Response(packed).blob())).split(',');
  return new Blob([before, PLACE, code, after], { type: blob.type });
}
