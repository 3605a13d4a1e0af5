/* The keyboard shortcuts of the whole page and the dialog that lists them. exports: createKeys(lab), showHelp() */

import { say } from './shared/language.js';
import { dialog, element, table } from './shared/ui.js';

const list = [
  ['Ctrl Z', 'undo; Ctrl Shift Z or Ctrl Y: redo'],
  ['Ctrl S', 'save the scene'],
  ['?', 'show this list'],
  ['T, P', 'large text, projector mode'],
  ['2', 'the bench in two dimensions: a section through the scene, and back to the image'],
  ['Arrow keys', 'on the image: orbit by 5°, with Shift by 1°'],
  ['W S, A D, Q E', 'on the image: step forward and back, left and right, down and up; with Shift a tenth of a step'],
  ['Page Up, Page Down', 'on the image: nearer to or farther from the pivot, which stays; with Shift a little'],
  ['Z, X, Y', 'on the image: look from the front, the right, the top; with Shift from the back, the left'],
  ['Home, . (full stop)', 'on the image: show all objects, the selected object'],
  ['B, Shift B', 'on the image: previous and next view; undo does not change views'],
  ['K, H', "on the image: keep the view as the scene's own camera; return to that camera"],
  [say('+ and -, 0, 1'), 'on the image: magnify, fit the image, actual pixels'],
  ['Ctrl arrow keys', 'on the image: scroll the image'],
  ['Ctrl wheel', 'magnify about the pointer; without Ctrl, with Orbit, Object, Light: nearer and farther'],
  ['Middle mouse button', 'and drag: pan the camera; with two fingers: pan, and pinch for nearer and farther'],
  ['Space', 'and drag: scroll the image'],
  ['G, N', 'with Object: next handles (move, turn, scale), snap on or off'],
  ['Tab, arrow keys', 'with Object: from handle to handle; a step of the handle, with Shift a tenth'],
  [
    'Enter',
    'with Grab, on the image: grab or release the slime; arrow keys pull, Page Up and ' +
      'Page Down pull along the view',
  ],
  ['Escape', 'while dragging: take the drag back'],
  ['Shift drag', 'with Orbit: pan; with Light: nearer and farther; on a handle: snap'],
  ['Ctrl drag', 'with Orbit: turn in place'],
  [
    'Arrow keys with Inspect',
    'on the image: move the selected pixel by one, with Shift by ten; Escape clears the selection',
  ],
  [
    'Tab, arrow keys, R',
    'in the section: from object to object; a step of the grid, with Shift a tenth; turn by 5°, with Shift back',
  ],
  [
    say('A, I, G, N, 0, Escape'),
    'in the section: angles, images, grid, snap, show all; cancel a drag, clear the selection, close',
  ],
  ['F', 'while held: show the reference image A'],
  ['Home on the splitter', 'reset the width of the panels; arrow keys change it'],
];

export function showHelp() {
  const keyed = list.map(([keys, what]) => [element('kbd', { text: keys }), what]);
  dialog({
    title: 'Keyboard shortcuts',
    wide: true,
    content: table({
      caption: 'Keyboard shortcuts',
      hideCaption: true,
      columns: ['Keys', 'Action'],
      rows: keyed,
    }),
  });
}

const DISPLAY = { t: 'text', p: 'projector' };

const writes = (target) =>
  target.closest?.(
    'input:not([type=range]):not([type=checkbox]):not([type=radio]):not([type=color]), textare' +
      'a, select, [contenteditable]',
  );

/* Commits a field that is being edited before saving. */
function save(field, lab) {
  if (writes(field)) {
    field.blur();
    field.focus({ preventScroll: true });
  }
  lab.save?.();
}

export function createKeys(lab) {
  document.addEventListener('keydown', (event) => {
    if (event.defaultPrevented || document.querySelector('dialog[open]')) return;
    const letter = event.key.toLowerCase();
    const control = (event.ctrlKey || event.metaKey) && !event.altKey;
    const saves = control && letter === 's' && !event.shiftKey;
    if (writes(event.target) && !saves) return;
    if (saves) save(event.target, lab);
    else if (control && letter === 'z') lab.undo(event.shiftKey);
    else if (control && letter === 'y') lab.undo(true);
    else if (event.key === '?' && !control) showHelp();
    else if (event.key === '2' && !control && !event.altKey && lab.section) lab.section.toggle();
    else if (DISPLAY[letter] && !control && !event.altKey) lab.display.toggle(DISPLAY[letter]);
    else return;
    event.preventDefault();
  });
}
