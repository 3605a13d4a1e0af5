/* The dialog Share: the forms in which the scene leaves the laboratory, and a shared file opened again.
 * exports: share(lab) */

import { button, dialog, element } from './ui.js';
import { saveFile } from './save_file.js';
import { copyLink } from './shared_link.js';
import { openFile } from './shared_file.js';

export function share(lab) {
  const input = element('input', { type: 'file', accept: '.png,.html', hidden: true });
  const act = (what) => () => {
    made.close();
    what();
  };
  const made = dialog({
    title: 'Share',
    content: [
      form(
        'Copy link',
        'copy',
        'A link with the scene, for a laboratory at the same address on this machine. Others can open the HTML file.',
        act(() => copyLink(lab)),
      ),
      form(
        'PNG with the scene',
        'image',
        'The image; Cuvette opens it again as a scene.',
        act(() => saveFile(lab, '/api/picture.png?wait=1&scene=1', 'png')),
      ),
      form(
        'HTML file',
        'save',
        'Image, rays with their numbers, scene and command in one file that every browser opens, without Cuvette.',
        act(() => saveFile(lab, '/api/page.html', 'html')),
      ),
      form('Open a shared file …', 'folder', 'A PNG or HTML file, which can also be dropped on the page.', () =>
        input.click(),
      ),
      input,
    ],
  });
  input.addEventListener('change', () => {
    made.close();
    if (input.files[0]) openFile(lab, input.files[0]);
  });
}

function form(label, icon, words, act) {
  return element(
    'div',
    { class: 'share-form' },
    button(label, act, { icon }),
    element('p', { class: 'hint', text: words }),
  );
}
