/* Prints sheets of paper instead of the page: the image with what is drawn over it, and text, black on white
 * (print.css).
 * exports:
 *   createPrint(lab)                       Ctrl P and the browser's own command print the state of the page
 *   printState(lab)                        prints it: image, title, changed parameters and command
 *   printSheets(sheets)                    prints these elements, each a page of its own
 *   sheet(properties, ...children)         such an element
 *   imageOf(lab) -> promise of a node      the final image, or the section, as it is shown
 *   printCode(title, drawing, address)     prints a QR code */

import { digits, element, vector } from './ui.js';

const MOST_CHANGES = 30;
const OF_TOOLS = '.layer-gizmo, .layer-object, .layer-grab, .layer-compare';

export const sheet = (properties, ...children) => element('section', { class: 'sheet', ...properties }, ...children);

function put(sheets) {
  const all = element('div', { class: 'print-sheets' }, sheets);
  document.querySelector('.print-sheets')?.remove();
  document.body.append(all);
  addEventListener('afterprint', () => all.remove(), { once: true });
}

export function printSheets(sheets) {
  put(sheets);
  globalThis.print();
}

/* --- the image --- */

function canvasOf(source, from) {
  const canvas = element('canvas', { width: from.width, height: from.height });
  canvas.getContext('2d').drawImage(source, from.x, from.y, from.width, from.height, 0, 0, from.width, from.height);
  return canvas;
}

/* What the screen shows, for the browser's own command, which waits for nothing. */
function shownImage({ view }) {
  const upper = view.toScreen(0, 0);
  const lower = view.toScreen(view.width, view.height);
  const at = [upper.x, upper.y, lower.x - upper.x, lower.y - upper.y].map((x) => Math.round(x * devicePixelRatio));
  const [x, y, width, height] = at;
  return canvasOf(view.stage.querySelector('canvas'), { x, y, width, height });
}

async function finalImage(lab) {
  try {
    const bitmap = await createImageBitmap((await lab.blob('/api/image.png?wait=1')).blob);
    return canvasOf(bitmap, { x: 0, y: 0, width: bitmap.width, height: bitmap.height });
  } catch {
    return shownImage(lab);
  }
}

/* Rays, beams and rulers, but not the marks of the tools. */
function layersOf({ view }) {
  const layers = view.stage.querySelector('.view-layers').cloneNode(true);
  for (const node of layers.querySelectorAll(OF_TOOLS)) node.remove();
  layers.setAttribute('viewBox', `0 0 ${view.width} ${view.height}`);
  layers.firstElementChild.removeAttribute('transform');
  return layers;
}

function framed(lab, canvas) {
  const figure = element('figure', { class: 'sheet-image' }, canvas, layersOf(lab));
  figure.style.setProperty('--ratio', lab.view.width / lab.view.height);
  return figure;
}

const sectionOf = (lab) => element('figure', { class: 'sheet-section' }, lab.section.copy());

export const imageOf = async (lab) => (lab.section?.shown ? sectionOf(lab) : framed(lab, await finalImage(lab)));

/* --- the state of the page --- */

const written = (value) =>
  Array.isArray(value) ? vector(value, 6) : typeof value === 'number' ? digits(value, 6) : String(value);

function changesOf(lab) {
  const rows = lab.scene.params.filter(
    ({ value, initial }) => initial !== null && initial !== undefined && String(value) !== String(initial),
  );
  if (!rows.length) return null;
  const listed = rows.slice(0, MOST_CHANGES);
  return [
    element('h2', { text: 'Changed parameters' }),
    element(
      'table',
      { class: 'sheet-table' },
      element(
        'tr',
        {},
        ['Parameter', 'Opened with', 'Now'].map((text) => element('th', { scope: 'col', text })),
      ),
      listed.map(({ path, unit, value, initial }) =>
        element(
          'tr',
          {},
          element('th', { scope: 'row', text: unit ? `${path} (${unit})` : path }),
          element('td', { text: written(initial) }),
          element('td', { text: written(value) }),
        ),
      ),
    ),
    rows.length > listed.length ? element('p', { text: `+ ${rows.length - listed.length}` }) : null,
  ];
}

function stateSheet(lab, image, command) {
  return sheet(
    {},
    element('h1', { text: lab.state.title || 'Cuvette' }),
    element('p', { class: 'sheet-file', text: lab.state.file }),
    image,
    lab.scene ? changesOf(lab) : null,
    command ? [element('h2', { text: 'Command' }), element('pre', { class: 'sheet-command', text: command })] : null,
  );
}

export async function printState(lab) {
  const { command } = await lab.get('/api/command').catch(() => ({}));
  printSheets([stateSheet(lab, await imageOf(lab), command)]);
}

export function createPrint(lab) {
  document.addEventListener('keydown', (event) => {
    const prints = (event.ctrlKey || event.metaKey) && !event.altKey && !event.shiftKey;
    if (!prints || event.key.toLowerCase() !== 'p' || event.defaultPrevented || !lab.view.width) return;
    event.preventDefault();
    printState(lab).catch(lab.fail);
  });
  addEventListener('beforeprint', () => {
    if (document.querySelector('body > .print-sheets, body > .section-print') || !lab.view.width) return;
    put([stateSheet(lab, lab.section?.shown ? sectionOf(lab) : framed(lab, shownImage(lab)))]);
  });
}

export const printCode = (title, drawing, address) =>
  printSheets([
    sheet(
      { class: 'sheet sheet-code' },
      element('h1', { text: title }),
      drawing,
      address.length < 200 ? element('p', { class: 'sheet-command', text: address }) : null,
    ),
  ]);
