/* The keys of the image that move the camera, and the commands for views, which the camera box shows as buttons.
 * exports: createCameraKeys(lab, settings) -> key(event) -> true when handled; settings.length: the step of W A S D Q
 *          E; viewCommands(lab) -> [{name, label, keys, title, act}] */

import { goView, moveCamera } from './camera_moves.js';
import { gesture } from './ui.js';

const ORBIT = 5;
const FINE_ORBIT = 1;
const ZOOM = 1.1; /* of Page Up and Page Down */
const FINE_ZOOM = 1.01;

const STEPS = { a: [-1, 0, 0], d: [1, 0, 0], e: [0, 1, 0], q: [0, -1, 0], w: [0, 0, 1], s: [0, 0, -1] };
const ARROWS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export function viewCommands(lab) {
  const move = (body) => moveCamera(lab, body, gesture('view'));
  const look = (side) => () => move({ look: side });
  const frame = () => {
    if (!lab.choice?.name) return lab.say('Select an object to frame it.');
    return move({ frame: lab.choice.name });
  };
  return [
    { name: 'front', label: 'Front', keys: 'z', title: 'Look along +z', act: look('front') },
    { name: 'back', label: 'Back', keys: 'Shift z', title: 'Look along -z', act: look('back') },
    { name: 'right', label: 'Right', keys: 'x', title: 'From the right: look along -x', act: look('right') },
    { name: 'left', label: 'Left', keys: 'Shift x', title: 'From the left: look along +x', act: look('left') },
    { name: 'top', label: 'Top', keys: 'y', title: 'Look straight down', act: look('top') },
    { name: 'frame', label: 'Frame', keys: '.', title: 'Show all of the selected object', act: frame },
    {
      name: 'all',
      label: 'Frame all',
      keys: 'Home',
      title: 'Show all objects',
      act: () => move({ frame: 'all' }),
    },
    {
      name: 'home',
      label: "Scene's view",
      keys: 'h',
      title: "Return to the scene's own camera",
      act: () => goView(lab, 'home'),
    },
    {
      name: 'keep',
      label: 'Keep view',
      keys: 'k',
      title: "Make this view the scene's own camera, to be saved with it",
      act: () => goView(lab, 'keep'),
    },
    { name: 'earlier', label: 'Previous view', keys: 'b', title: 'Previous view', act: () => goView(lab, 'back') },
    { name: 'later', label: 'Next view', keys: 'Shift b', title: 'Next view', act: () => goView(lab, 'forward') },
  ];
}

export function createCameraKeys(lab, settings) {
  const commands = new Map(viewCommands(lab).map((each) => [each.keys.toLowerCase(), each.act]));
  let held = null;
  lab.view.stage.addEventListener('keyup', () => {
    held = null;
  });

  return (event) => {
    const letter = event.key.toLowerCase();
    const command = commands.get(event.shiftKey && letter.length === 1 ? `shift ${letter}` : letter);
    let body = null;
    if (command) {
      if (!event.repeat) command();
      return true;
    }
    if (ARROWS[event.key]) body = { orbit: ARROWS[event.key].map((x) => x * (event.shiftKey ? FINE_ORBIT : ORBIT)) };
    else if (STEPS[letter]) body = { step: STEPS[letter].map((x) => x * settings.length * (event.shiftKey ? 0.1 : 1)) };
    else if (event.key === 'PageUp' || event.key === 'PageDown') {
      const factor = event.shiftKey ? FINE_ZOOM : ZOOM;
      body = { zoom: event.key === 'PageUp' ? 1 / factor : factor };
    }
    if (!body) return false;
    held ??= gesture('key');
    moveCamera(lab, body, held);
    return true;
  };
}
