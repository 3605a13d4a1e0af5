/* The dialog Save image. What is drawn over the image is saved with it by a switch, which is remembered.
 * exports: saveImage(lab) */

import { say } from './language.js';
import { withScene } from './png_chunks.js';
import { saveFile, savePage } from './save_file.js';
import { dataAddress, drawingOver, paint, settled, textOf } from './snapshot.js';
import { button, checkbox, choice, dialog, element, memory, svg } from './ui.js';

const PNG = '/api/image.png?wait=1&scene=1';
const JPEG = '/api/image.jpg?wait=1';

const FORMATS = [
  ['png', 'PNG'],
  ['jpg', 'JPEG'],
  ['svg', 'SVG'],
  ['html', 'HTML'],
];

const explained = (format) =>
  ({
    png: say('PNG: every pixel is exact, and Cuvette opens the file again as a scene.'),
    jpg: say('JPEG: a smaller file, with small errors.'),
    svg: say('SVG: the image, with lines and texts over it that a drawing program can change.'),
    html: say('HTML: image, rays with their numbers, scene and command in a page for every browser.'),
  })[format];

export function saveImage(lab) {
  const about = element('p', { class: 'hint' });
  const explain = () => {
    about.textContent = explained(format.value);
  };
  const format = choice({
    label: 'Format',
    radios: true,
    value: memory.get('image.format', 'png'),
    choices: FORMATS,
    onchange: explain,
  });
  const over = checkbox('With rays, angles and ruler', memory.get('image.over', true));
  const save = button('Save', act, { icon: 'save', kind: 'primary' });
  const made = dialog({
    title: 'Save image',
    content: [format.node, about, over.node, element('div', { class: 'buttons' }, save)],
  });
  explain();

  function act() {
    memory.set('image.format', format.value);
    memory.set('image.over', over.value);
    made.close();
    write(lab, format.value, over.value);
  }
}

/* A drawing is copied when it belongs to the newest image. */
async function write(lab, format, over) {
  lab.say(say('Waiting for the final image …'));
  await settled(lab);
  const drawing = over ? drawingOver(lab) : null;
  const painted = async (blob, how) => (await paint(lab, blob, drawing)).convertToBlob(how);
  if (format === 'html') await savePage(lab, '', drawing);
  else if (format === 'svg') await saveFile(lab, PNG, 'svg', '', (blob) => asSvg(lab, blob, drawing));
  else if (format === 'jpg' && drawing)
    await saveFile(lab, PNG, 'jpg', '', (blob) => painted(blob, { type: 'image/jpeg', quality: 0.95 }));
  else if (format === 'jpg') await saveFile(lab, JPEG, 'jpg');
  else await saveFile(lab, PNG, 'png', '', async (blob) => (drawing ? again(blob, await painted(blob)) : blob));
}

/* The painted image as a file that holds the scene, too. */
async function again(from, painted) {
  const [scene, bytes] = await Promise.all(
    [from, painted].map(async (blob) => new Uint8Array(await blob.arrayBuffer())),
  );
  return new Blob(withScene(bytes, scene), { type: 'image/png' });
}

async function asSvg(lab, blob, drawing) {
  const { width, height } = lab.view;
  const file = drawing ?? svg('svg', { xmlns: 'http://www.w3.org/2000/svg', width, height });
  file.prepend(
    svg('title', {}, lab.state.title || lab.name()),
    svg('image', { width, height, href: await dataAddress(blob) }),
  );
  return new Blob([textOf(file)], { type: 'image/svg+xml' });
}
