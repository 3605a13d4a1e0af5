/* Shared scenes: links, files of the reader's computer, and the dialog Share. A link is the fragment #scene=CODE of the
 * page's address; PNG images and HTML files hold the same code, which the laboratory checks. A saved page that contains
 * the laboratory may hold a code, too (report/page.h).
 * exports:
 *   namesScene()        whether the page or its address has a scene, or the address names a file (engine_boot.js)
 *   openLink(lab)       opens that scene, and the scene of each later fragment of the address; after a reload only if
 *                       the engine does not have it any more
 *   acceptDrops(lab)    opens a file that is dropped on the page: one with a scene, or a lens file
 *   openLens(lab, name, text)   opens the scene of a lens file
 *   LENS_FILES          endings of lens files
 *   openFile(lab, file)
 *   share(lab)          the dialog: copies a link, saves a file with the scene, and opens such a file */

import { name, named, returned } from './address.js';
import { say } from './language.js';
import { codeOfPng } from './png_chunks.js';
import { printCode, printState } from './print.js';
import { saveFile, savePage } from './save_file.js';
import { createLinks } from './share_link.js';
import { button, dialog, element, notice, replace, write } from './ui.js';

/* --- links --- */

const embedded = document.getElementById('cuvette-scene')?.textContent;
export const namesScene = () => Boolean(embedded || named().scene) || new URLSearchParams(location.search).has('scene');

export async function openLink(lab) {
  addEventListener('hashchange', () => openFragment(lab));
  lab.on('opened', ({ link, lesson }) => name(link || (lesson ? `#lesson=${lesson}` : '')));
  if (returned() && (await lab.rescue.hasScene())) return;
  if (embedded) await openText(lab, `#scene=${embedded}`);
  else await openFragment(lab);
}

async function openFragment(lab) {
  const link = named().scene;
  if (link) await openText(lab, link);
}

async function openText(lab, link) {
  try {
    await lab.change('/api/open', { link });
    lab.panels.reveal();
    lab.say('The shared scene is shown. Undo restores the previous scene.');
  } catch (error) {
    lab.fail(error);
  }
}

/* --- files: PNG images and HTML pages --- */

const BEGIN = '<script type="text/plain" id="cuvette-scene">';
const LARGEST_LENS = 500000; // bytes, so that a request can hold it
const LARGEST = 1 << 28; // bytes, as for files of the laboratory's folder

export const LENS_FILES = '.zmx,.dat,.csv';

export async function openLens(lab, name, text) {
  try {
    const { note } = await lab.change('/api/open', { lens: name, text });
    lab.say(say('The scene of {name} is shown; Undo restores the previous one.', { name }), note);
  } catch (error) {
    lab.fail(error);
  }
}

/* Zemax writes UTF-16 with its mark. */
function textOf(bytes) {
  const mark = bytes[0] * 256 + bytes[1];
  return new TextDecoder(mark === 0xfffe ? 'utf-16le' : mark === 0xfeff ? 'utf-16be' : 'utf-8').decode(bytes);
}

export async function openFile(lab, file) {
  if (LENS_FILES.split(',').some((ending) => file.name.toLowerCase().endsWith(ending))) {
    if (file.size < LARGEST_LENS) await openLens(lab, file.name, textOf(new Uint8Array(await file.arrayBuffer())));
    else lab.fail({ message: say('{name} is too large', file), remedy: 'choose a lens file below 500 kB' });
    return;
  }
  const code = file.size <= LARGEST ? codeOf(new Uint8Array(await file.arrayBuffer())) : null;
  if (code) await openText(lab, `#scene=${code}`);
  else
    lab.fail({
      message: say('{name} holds no scene', file),
      remedy: 'choose a PNG image or HTML file of Cuvette; an image of a scene that reads files holds none',
    });
}

export function acceptDrops(lab) {
  const holdsFile = (event) => event.dataTransfer?.types.includes('Files');
  addEventListener('dragover', (event) => {
    if (holdsFile(event)) event.preventDefault();
  });
  addEventListener('drop', (event) => {
    if (!holdsFile(event)) return;
    event.preventDefault();
    openFile(lab, event.dataTransfer.files[0]);
  });
}

function codeOf(bytes) {
  const png = [0x89, 0x50, 0x4e, 0x47].every((byte, at) => bytes[at] === byte);
  return png ? codeOfPng(bytes) : codeOfPage(new TextDecoder().decode(bytes));
}

function codeOfPage(text) {
  const at = text.indexOf(BEGIN);
  return at < 0 ? null : text.slice(at + BEGIN.length).split('<', 1)[0];
}

/* --- the dialog --- */

/* {link: the scene as the fragment of an address} or {refusal: why it cannot be shared, such as its files}. */
async function linkOf(lab) {
  try {
    const { fragment, code } = await lab.get('/api/link');
    return { link: fragment + code, refusal: null };
  } catch (error) {
    return { link: null, refusal: error.status === 409 ? error : null };
  }
}

export function share(lab) {
  const input = element('input', { type: 'file', accept: '.png,.html', hidden: true });
  const linking = linkOf(lab);
  const refusing = linking.then(({ refusal }) => refusal);
  const act = (what) => async () => {
    made.close();
    what(await refusing);
  };
  const save = (file) => act((refusal) => file(refusal ? refusal.message : ''));
  const links = createLinks(lab, {
    code: linking.then(({ link }) => link),
    print: printCode,
    copied(words) {
      made.close();
      lab.say(words);
    },
  });
  const png = form(
    'PNG with the scene',
    'download',
    'The image; Cuvette opens it again as a scene.',
    save((refusal) => saveFile(lab, '/api/image.png?wait=1&scene=1', 'png', refusal)),
  );
  const html = form(
    'HTML file',
    'download',
    'Image, rays with their numbers, scene and command in one file that every browser opens, without Cuvette. ' +
      'If this laboratory has the engine for browsers, the reader can also turn the scene.',
    save((refusal) => savePage(lab, refusal)),
  );
  const trouble = element('div', { 'aria-live': 'polite' });
  const made = dialog({
    title: 'Share',
    content: [
      trouble,
      links,
      png.node,
      html.node,
      form('Print …', 'image', 'Image, title, changed parameters and command on a page, or in a PDF file.', () => {
        made.close();
        printState(lab).catch(lab.fail);
      }).node,
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
  refusing.then((refusal) => {
    if (!refusal) return;
    const message = say('No link, and files are saved without the scene: {reason}.', { reason: refusal.message });
    replace(trouble, notice(message, { kind: 'warning', remedy: refusal.remedy }));
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
    set(nextLabel, nextWords) {
      write(made.querySelector('.button-label'), { textContent: nextLabel });
      write(hint, { textContent: nextWords });
    },
  };
}
