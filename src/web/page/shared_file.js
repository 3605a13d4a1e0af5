/* Shared scenes in files of the reader's computer: PNG images and HTML files. Both hold the same compressed text as a
 * link, which the laboratory checks.
 * exports: openFile(lab, file)   opens the scene of a file
 *          acceptDrops(lab)      opens a file that is dropped on the page */

import { openText } from './shared_link.js';

const BEGIN = '<script type="text/plain" id="cuvette-scene">';
const KEYWORD = 'Cuvette scene';
const LARGEST = 1 << 28; // bytes, as for files of the laboratory's folder

export async function openFile(lab, file) {
  const code = file.size <= LARGEST ? codeOf(new Uint8Array(await file.arrayBuffer())) : null;
  if (code) await openText(lab, `#scene=${code}`);
  else
    lab.fail({
      message: `${file.name} holds no scene`,
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

/* The chunks of a PNG: length, type, data, checksum. iTXt (PNG specification, 11.3.3): keyword, 0, compressed, method,
 * language, 0, translated keyword, 0, text. */
function codeOfPng(bytes) {
  const view = new DataView(bytes.buffer);
  for (let at = 8; at + 12 <= bytes.length; at += 12 + view.getUint32(at)) {
    const data = bytes.subarray(at + 8, at + 8 + view.getUint32(at));
    if (word(bytes.subarray(at + 4, at + 8)) !== 'iTXt' || word(data.subarray(0, KEYWORD.length)) !== KEYWORD) continue;
    const rest = data.subarray(KEYWORD.length + 3);
    const text = rest.subarray(rest.indexOf(0, rest.indexOf(0) + 1) + 1);
    return data[KEYWORD.length + 1] === 1 ? base64url(text) : null;
  }
  return null;
}

const word = (bytes) => String.fromCharCode(...bytes);

function base64url(bytes) {
  let text = '';
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}
