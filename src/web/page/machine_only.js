/* What a laboratory in the browser leaves to the program on the machine: the reason, and the commands that do it.
 * exports: needsProgram(lab, reason, commands) -> node; commands: texts, or functions of the scene's file name */

import { button, element, notice } from './ui.js';
import { commandRow } from './command_row.js';
import { saveReply } from './save_file.js';

const REMEDY = 'save the scene, and run these commands of Cuvette on a computer';

export function needsProgram(lab, reason, commands) {
  const file = `${lab.name()}.yaml`;
  const texts = commands.map((command) => (typeof command === 'function' ? command(file) : command));
  return element(
    'div',
    { class: 'needs-program' },
    notice(reason, { remedy: texts.some((text) => text.includes(file)) ? REMEDY : 'run this command of Cuvette' }),
    element(
      'div',
      { class: 'buttons' },
      button('Save the scene', () => saveReply(lab, '/api/scene.yaml', file), { icon: 'save', small: true }),
    ),
    texts.map((text) => commandRow(lab, text)),
  );
}
