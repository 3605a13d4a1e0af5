/* The dialog Share: the forms in which the scene leaves the laboratory, and a shared file opened again.
 * exports: share(lab) */

import { button, dialog, element, notice, replace } from './ui.js';
import { saveFile, savePage } from './save_file.js';
import { copyLink } from './shared_link.js';
import { openFile } from './shared_file.js';

/* Why the scene cannot be shared, such as the files that it names; null if it can. */
async function refusalOf(lab) {
  try {
    await lab.get('/api/link');
  } catch (error) {
    if (error.status === 409) return error;
  }
  return null;
}

export function share(lab) {
  const input = element('input', { type: 'file', accept: '.png,.html', hidden: true });
  const asked = refusalOf(lab);
  const act = (what) => async () => {
    made.close();
    what(await asked);
  };
  const save = (file) => act((refusal) => file(refusal ? ` without the scene: ${refusal.message}` : ''));
  const link = form(
    'Copy link',
    'copy',
    lab.engine.kind === 'server'
      ? 'A link with the scene, for a laboratory at the same address on this machine. Others can open the HTML file.'
      : 'A link with the scene, which opens in any browser that can reach this page.',
    act(() => copyLink(lab)),
  );
  const png = form(
    'PNG with the scene',
    'image',
    'The image; Cuvette opens it again as a scene.',
    save((more) => saveFile(lab, '/api/picture.png?wait=1&scene=1', 'png', more)),
  );
  const html = form(
    'HTML file',
    'save',
    'Image, rays with their numbers, scene and command in one file that every browser opens, without Cuvette. ' +
      'With the engine for browsers, if this laboratory has it, the reader can turn the scene too.',
    save((more) => savePage(lab, more)),
  );
  const trouble = element('div', { 'aria-live': 'polite' });
  const made = dialog({
    title: 'Share',
    content: [
      trouble,
      link.node,
      png.node,
      html.node,
      form('Open a shared file …', 'folder', 'A PNG or HTML file, which can also be dropped on the page.', () =>
        input.click(),
      ).node,
      input,
    ],
  });
  input.addEventListener('change', () => {
    made.close();
    if (input.files[0]) openFile(lab, input.files[0]);
  });
  asked.then((refusal) => {
    if (!refusal) return;
    const message = `Files are saved without the scene: ${refusal.message}.`;
    replace(trouble, notice(message, { kind: 'warning', remedy: refusal.remedy }));
    link.set('Copy link', 'Not possible for this scene.', true);
    png.set('PNG without the scene', 'The image alone; Cuvette cannot open it as a scene.');
    html.set(
      'HTML file without the scene',
      'Image, rays with their numbers and command; Cuvette cannot open it as a scene.',
    );
  });
}

function form(label, icon, words, act) {
  const made = button(label, act, { icon });
  const hint = element('p', { class: 'hint', text: words });
  return {
    node: element('div', { class: 'share-form' }, made, hint),
    set(nextLabel, nextWords, disabled = false) {
      made.querySelector('.button-label').textContent = nextLabel;
      made.disabled = disabled;
      hint.textContent = nextWords;
    },
  };
}
