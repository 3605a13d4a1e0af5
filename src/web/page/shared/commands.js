/* Commands of the program, for the reader to run.
 * exports:
 *   commandRow(lab, text) -> node                        a command with a button that copies it
 *   needsProgram(lab, reason, commands) -> node          what a laboratory in the browser leaves to the program on the
 *                                                        machine; commands: texts, or functions of the scene's file */

import { saveReply } from './save_file.js';
import { button, copy, element, notice } from './ui.js';

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

export function needsProgram(lab, reason, commands) {
  const file = `${lab.name()}.yaml`;
  const ofScene = commands.some((command) => typeof command === 'function');
  const save = () => saveReply(lab, '/api/scene.yaml', file);
  return element(
    'div',
    { class: 'needs-program' },
    notice(reason, {
      remedy: ofScene ? 'save the scene, and run Cuvette on a computer:' : 'run Cuvette on a computer:',
    }),
    ofScene
      ? element('div', { class: 'buttons' }, button('Save the scene', save, { icon: 'save', small: true }))
      : null,
    commands.map((command) => commandRow(lab, typeof command === 'function' ? command(file) : command)),
  );
}
