/* The page header: scene name, undo, save and copy, theme.
 * exports: createHead(root, lab); sets lab.undo(redo) and lab.name() (the scene's file name without folder and
 * extension) */

import { say, translated } from './shared/language.js';
import { saveVideo } from './edit/video_dialog.js';
import { showHelp } from './keys.js';
import { displayButton, themeButton } from './shared/display.js';
import { languageMenu } from './shared/language_menu.js';
import { saveImage } from './shared/save_image.js';
import { ask, button, copy, element, icon, write } from './shared/ui.js';

export function createHead(root, lab) {
  lab.undo = (redo = false) => lab.change(redo ? '/api/redo' : '/api/undo', {}).catch(lab.fail);
  lab.name = () =>
    (lab.state?.file || lab.state?.title || 'scene')
      .split('/')
      .pop()
      .replace(/\.ya?ml$/, '')
      .replace(/[^\w.-]+/g, '-') || 'scene';

  const title = element('h1', { class: 'scene-title', text: 'Cuvette' });
  const file = element('span', { class: 'scene-file' });
  const mark = element('span', { class: 'unsaved', hidden: true, text: 'unsaved' });
  const undo = button('Undo', () => lab.undo(), { icon: 'undo', kind: 'quiet', disabled: true });
  const redo = button('Redo', () => lab.undo(true), { icon: 'redo', kind: 'quiet', disabled: true });
  const reset = button('Reset all', () => resetAll(lab), {
    icon: 'reset',
    kind: 'quiet',
    title: 'Put everything back as it was when the scene was opened',
  });
  root.append(
    element('div', { class: 'brand' }, icon('cuvette'), element('span', { text: 'Cuvette' })),
    element('div', { class: 'scene-name' }, title, file, mark),
    element('div', { class: 'head-group', role: 'group', 'aria-label': 'History' }, undo, redo, reset),
    element(
      'div',
      { class: 'head-group', role: 'group', 'aria-label': 'Save and copy' },
      button('Image', () => saveImage(lab), {
        icon: 'download',
        kind: 'quiet',
        title: 'Save the image: PNG, JPEG, SVG or HTML, with or without rays',
        'aria-label': 'Save image',
      }),
      button('Video', () => saveVideo(lab), {
        icon: 'video',
        kind: 'quiet',
        title: 'Save a video: something that changes step by step, or the slime',
        'aria-label': 'Save video',
      }),
      button('Scene', () => copyScene(lab), {
        icon: 'copy',
        kind: 'quiet',
        title: 'Copy the scene as text',
        'aria-label': 'Copy scene file',
      }),
      button('Command', () => copyCommand(lab), {
        icon: 'terminal',
        kind: 'quiet',
        title: 'Copy the command that renders this image',
        'aria-label': 'Copy render command',
      }),
    ),
    element(
      'div',
      { class: 'head-group' },
      languageMenu(lab),
      displayButton(lab),
      themeButton(),
      button('Help', showHelp, { icon: 'help', kind: 'quiet', bare: true, title: 'Keyboard shortcuts (?)' }),
    ),
  );

  lab.on('state', (state) => {
    write(title, { textContent: state.title || 'Untitled scene' });
    write(file, { textContent: state.file || 'not saved to a file yet' });
    write(mark, { hidden: !state.unsaved });
    write(document, { title: `${state.unsaved ? '• ' : ''}${state.title || 'Cuvette'}` });
    const [undone, redone] = [state.undo, state.redo].map(translated);
    write(undo, { disabled: !undone, title: undone ? say('Undo {what}', { what: undone }) : say('Nothing to undo') });
    write(redo, { disabled: !redone, title: redone ? say('Redo {what}', { what: redone }) : say('Nothing to redo') });
  });
}

async function resetAll(lab) {
  const yes = await ask(
    'Reset all',
    'Reset all values and objects to their state when the scene was ' + 'opened? Undo reverts the reset.',
    'Reset all',
  );
  if (yes) lab.change('/api/reset', {}).then(() => lab.say('The scene is reset.'), lab.fail);
}

async function copyScene(lab) {
  try {
    const { blob } = await lab.blob('/api/scene.yaml');
    await copy(await blob.text());
    lab.say('The scene file is on the clipboard.');
  } catch (error) {
    lab.fail(error);
  }
}

async function copyCommand(lab) {
  try {
    const { command, complete } = await lab.get('/api/command');
    await copy(command);
    lab.say(
      complete
        ? 'The command is on the clipboard.'
        : 'The command is on the clipboard, but no file has all objects of the scene: save the scene first.',
    );
  } catch (error) {
    lab.fail(error);
  }
}
