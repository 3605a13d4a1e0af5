/* What a laboratory in the browser leaves to the program on the machine: the reason, and the commands that do it.
 * exports: needsProgram(lab, reason, commands) -> node; commands: texts, or functions of the scene's file name */

import { button, element, notice } from './ui.js';
import { commandRow } from './command_row.js';
import { saveReply } from './save_file.js';

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
