/* The camera box under the image: views from the sides and of objects, exact steps, and fields for position and aim;
 * buttons in the toolbar go through the history of views; keys of the image move the camera too.
 * exports: cameraBox(root, lab); sets lab.view.camera: {key(event) -> true when handled} */

import { translated } from '../shared/language.js';
import { button, choice, element, gesture, memory, number } from '../shared/ui.js';
import { goView, moveCamera } from './camera_moves.js';

/* --- keys, and the commands for views, which the box shows as buttons --- */

const ORBIT = 5;
const FINE_ORBIT = 1;
const ZOOM = 1.1; /* of Page Up and Page Down */
const FINE_ZOOM = 1.01;

const STEPS = { a: [-1, 0, 0], d: [1, 0, 0], e: [0, 1, 0], q: [0, -1, 0], w: [0, 0, 1], s: [0, 0, -1] };
const ARROWS = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

function viewCommands(lab) {
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

function createCameraKeys(lab, settings) {
  const commands = new Map(viewCommands(lab).map((each) => [each.keys.toLowerCase(), each.act]));
  let keyGesture = null;
  lab.view.stage.addEventListener('keyup', () => {
    keyGesture = null;
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
    keyGesture ??= gesture('key');
    moveCamera(lab, body, keyGesture);
    return true;
  };
}

/* --- the box --- */

const AXES = ['x', 'y', 'z'];
const short = (x) => Number(x.toPrecision(5));
const TURNS = {
  around: ['Yaw: orbit to the left', 'Yaw: orbit to the right', 'Pitch: orbit upwards', 'Pitch: orbit downwards'],
  spot: ['Yaw: look left', 'Yaw: look right', 'Pitch: look up', 'Pitch: look down'],
};

export function cameraBox(root, lab) {
  const settings = {
    length: memory.get('camera.length', 0.2),
    angle: memory.get('camera.angle', 5),
    around: memory.get('camera.around', true),
  };
  const keep = (name, value) => {
    settings[name] = value;
    memory.set(`camera.${name}`, value);
  };
  const once = (body) => moveCamera(lab, body, gesture('camera'));
  const step = (direction) => once({ step: direction.map((x) => x * settings.length) });
  const turn = (right, up) =>
    once(
      settings.around
        ? { orbit: [-right * settings.angle, up * settings.angle] }
        : { turn: [right * settings.angle, up * settings.angle] },
    );
  const arrow = (name, drawing, act) => button(name, act, { icon: drawing, bare: true, small: true });

  const steps = element(
    'div',
    { class: 'pad', role: 'group', 'aria-label': 'Step' },
    arrow('Step left', 'left', () => step([-1, 0, 0])),
    arrow('Step right', 'right', () => step([1, 0, 0])),
    arrow('Step up', 'up', () => step([0, 1, 0])),
    arrow('Step down', 'down', () => step([0, -1, 0])),
    arrow('Step forward', 'forward', () => step([0, 0, 1])),
    arrow('Step back', 'back', () => step([0, 0, -1])),
  );
  const turned = [
    ['turnleft', -1, 0],
    ['turnright', 1, 0],
    ['tiltup', 0, 1],
    ['tiltdown', 0, -1],
  ].map(([drawing, right, up]) => arrow(' ', drawing, () => turn(right, up)));
  const turns = element('div', { class: 'pad', role: 'group', 'aria-label': 'Rotation' }, turned);
  const nameTurns = () =>
    turned.forEach((node, index) => {
      node.title = translated(TURNS[settings.around ? 'around' : 'spot'][index]);
      node.querySelector('.visually-hidden').textContent = node.title;
    });
  const length = number({
    label: 'Step',
    value: settings.length,
    min: 0.0001,
    max: 100000,
    unit: 'u',
    onchange: (x) => keep('length', x),
  });
  const angle = number({
    label: 'Turn',
    value: settings.angle,
    min: 0.001,
    max: 180,
    unit: '°',
    onchange: (x) => keep('angle', x),
  });
  const how = choice({
    label: 'Rotation',
    radios: true,
    choices: [
      ['around', 'Around target'],
      ['spot', 'In place'],
    ],
    value: settings.around ? 'around' : 'spot',
    onchange: (word) => {
      keep('around', word === 'around');
      nameTurns();
    },
  });
  nameTurns();
  const fields = element('div', { class: 'camera-fields' });
  const box = element(
    'div',
    { class: 'camera-box', hidden: true, role: 'region', 'aria-label': 'Camera' },
    viewButtons(lab),
    element('div', { class: 'camera-part' }, length.node, steps),
    element('div', { class: 'camera-part' }, angle.node, turns),
    how.group,
    fields,
  );
  root.append(box);

  const toggle = button('Camera', () => open(box.hidden), {
    icon: 'camera',
    kind: 'quiet',
    small: true,
    title: 'Place the camera by steps and numbers',
    'aria-expanded': 'false',
  });
  lab.view.bar.append(...historyButtons(lab), toggle);
  const rows = createFields(fields, lab);
  const open = (on) => {
    box.hidden = !on;
    toggle.setAttribute('aria-expanded', String(on));
    memory.set('camera.open', on);
  };
  open(memory.get('camera.open', false));
  lab.on('scene', rows.update);
  lab.view.camera = { key: createCameraKeys(lab, settings) };
}

const titleOf = ({ title, keys }) => `${translated(title)} (${keys.replace(/\b[a-z]$/, (x) => x.toUpperCase())})`;

/* The height of the image at the pivot stays. */
function setProjection(lab, parallel) {
  const { camera, view } = lab.state;
  const height = 2 * camera.half_height * view.distance;
  lab
    .set(
      parallel
        ? { 'camera.projection': 'orthographic', 'camera.view_height': Number(height.toPrecision(6)) }
        : { 'camera.projection': 'perspective' },
      gesture('camera'),
    )
    .catch(lab.fail);
}

function viewButtons(lab) {
  const parallel = button('Orthographic', () => setProjection(lab, !lab.state?.camera?.parallel), {
    small: true,
    pressed: false,
    title: 'Parallel rays: sizes do not depend on the distance, as in a technical drawing',
  });
  const shown = viewCommands(lab).slice(0, 9);
  const nodes = new Map(
    shown.map((each) => [each.name, button(each.label, each.act, { small: true, title: titleOf(each) })]),
  );
  lab.on('state', ({ view, camera }) => {
    for (const name of ['home', 'keep']) nodes.get(name).disabled = view.kept;
    parallel.setAttribute('aria-pressed', String(Boolean(camera?.parallel)));
  });
  return element(
    'div',
    { class: 'camera-part views', role: 'group', 'aria-label': 'Views' },
    ...nodes.values(),
    parallel,
  );
}

/* The buttons are always present: a button that appears would resize the image during a drag. */
function historyButtons(lab) {
  const [keep, back, forward] = viewCommands(lab).slice(8);
  const make = (each, more) =>
    button(each.label, each.act, { kind: 'quiet', small: true, title: titleOf(each), ...more });
  const nodes = [
    make(keep, { icon: 'bookmark', bare: true }),
    make(back, { icon: 'earlier', bare: true }),
    make(forward, { icon: 'later', bare: true }),
  ];
  for (const node of nodes.slice(1)) node.classList.add('view-history');
  lab.on('state', ({ view }) => {
    nodes[0].disabled = view.kept;
    nodes[1].disabled = !view.back;
    nodes[2].disabled = !view.forward;
  });
  return nodes;
}

/* Fields for the parameters of the camera that the scene has: position, target or yaw and pitch, roll, and field of
 * view or view height. */
function createFields(root, lab) {
  let kinds = '';
  let shown = [];
  const paths = ['camera.position', 'camera.target', 'camera.yaw_deg', 'camera.pitch_deg', 'camera.roll_deg'];
  const sizeOf = () => (lab.state?.camera?.parallel ? 'camera.view_height' : 'camera.fov_deg');

  const send = (path, value) =>
    lab.set({ [path]: value }, gesture('camera')).catch((error) => {
      lab.fail(error);
      update();
    });

  function vectorField(row) {
    const label = row.name[0].toUpperCase() + row.name.slice(1);
    const parts = AXES.map((axis, index) => {
      const part = number({
        value: row.value[index],
        min: row.lowest,
        max: row.highest,
        onchange: (x) =>
          send(
            row.path,
            lab.param(row.path).value.map((old, at) => (at === index ? x : old)),
          ),
      });
      part.input.setAttribute('aria-label', `${translated(label)} ${axis}`);
      return part;
    });
    return {
      node: element(
        'div',
        { class: 'camera-field', role: 'group', 'aria-label': label },
        element('span', { class: 'label', text: label }),
        parts.map((part) => part.node),
      ),
      set: (value) => parts.forEach((part, index) => part.set(short(value[index]))),
    };
  }

  function plainField(row) {
    const label =
      { yaw_deg: 'Yaw', pitch_deg: 'Pitch', roll_deg: 'Roll', fov_deg: 'Field of view', view_height: 'View height' }[
        row.name
      ] || row.name;
    const unit = row.unit === 'deg' ? '°' : '';
    const part = number({ label, value: row.value, unit, onchange: (x) => send(row.path, x) });
    part.node.classList.add('camera-field');
    return { node: part.node, set: (value) => part.set(short(value)) };
  }

  function update() {
    const rows = [...paths, sizeOf()].map((path) => lab.param(path)).filter(Boolean);
    const now = rows.map((row) => row.path).join();
    if (now !== kinds) {
      kinds = now;
      shown = rows.map((row) => (Array.isArray(row.value) ? vectorField(row) : plainField(row)));
      root.replaceChildren(...shown.map((each) => each.node));
    }
    rows.forEach((row, index) => shown[index].set(row.value));
  }
  return { update };
}
