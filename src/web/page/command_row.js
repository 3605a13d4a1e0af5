/* A command of the program with a button that copies it. exports: commandRow(lab, text) -> node */

import { button, copy, element } from './ui.js';

export const commandRow = (lab, text) =>
  element(
    'div',
    { class: 'command-row' },
    element('code', { text }),
    button('Copy', () => copy(text).then(() => lab.say('The command is on the clipboard.'), lab.fail), {
      icon: 'copy',
      bare: true,
      small: true,
    }),
  );
