/* Keys of the whole page, and the dialog that lists them. exports: createKeys(lab), showHelp() */

import { dialog, element, table } from './ui.js';

const list = [
  ['Ctrl Z', 'undo; Ctrl Shift Z or Ctrl Y redo'],
  ['Ctrl S', 'save the scene'],
  ['?', 'this list'],
  ['Arrow keys', 'on the picture: orbit by 5°, with Shift by 1°'],
  ['W S, A D, Q E', 'on the picture: step forward and back, left and right, down and up; with Shift a tenth of it'],
  ['Page Up, Page Down', 'on the picture: closer to the target, farther from it'],
  ['+ and -, 0, 1', 'on the picture: zoom, the whole picture, pixel for pixel'],
  ['Ctrl arrow keys', 'on the picture: move the zoomed picture'],
  ['Ctrl wheel', 'zoom about the pointer; wheel alone: forward and back while Orbit is chosen'],
  ['Space or middle button', 'and drag: move the zoomed picture'],
  [
    'Enter',
    'with Grab, on the picture: take hold of the slime and let go; arrow keys pull, Page Up and ' +
      'Page Down along the view',
  ],
  ['Shift drag', 'with Orbit: turn on the spot; with Light: nearer and farther'],
  ['Arrow keys with Ask', 'on the picture: the next pixel, with Shift the tenth; Escape clears'],
  ['F', 'while it is held: the pinned picture in place of the newest'],
  ['Home on the splitter', 'panels of their usual width; arrow keys make them wider and narrower'],
];

export function showHelp() {
  const keyed = list.map(([keys, what]) => [element('kbd', { text: keys }), what]);
  dialog({
    title: 'Keys',
    wide: true,
    content: table({
      caption: 'Keys and what they do',
      hideCaption: true,
      columns: ['Keys', 'What they do'],
      rows: keyed,
    }),
  });
}

const writes = (target) =>
  target.closest?.(
    'input:not([type=range]):not([type=checkbox]):not([type=radio]):not([type=color]), textare' +
      'a, select, [contenteditable]',
  );

/* What is being written in a field is part of what is saved. */
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
    else return;
    event.preventDefault();
  });
}
