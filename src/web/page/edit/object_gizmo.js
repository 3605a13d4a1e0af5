/* Handles of the selected object over the image, while the tool Object is active: arrows that move it along the world's
 * axes, rings that turn it about them, and a handle that scales it. Each handle is a button: dragging it or its arrow
 * keys change the object. Shift while dragging, or the switch Snap, rounds to the steps of the panel Objects.
 * exports: createGizmo(lab, choice, mark, movable(object)) -> {show(), hide(), key(event), snaps, inSteps(vector)} */

import { dragging, takeBack } from '../shared/escape.js';
import { say } from '../shared/language.js';
import { checkbox, choice as choiceOf, element, gesture, gestures, memory, svg } from '../shared/ui.js';
import { add, dot, minus, times, unit } from '../shared/vectors.js';
import { unitsPerPixel } from '../view/camera_moves.js';

const MODES = [
  ['move', 'Move'],
  ['turn', 'Turn'],
  ['scale', 'Scale'],
];
const SCALE_STEP = 0.1;
const signs = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };

const alongAxis = (axis, length) => AXES.map((_, at) => (at === axis ? length : 0));

export function createGizmo(lab, choice, mark, movable) {
  const { view } = lab;
  const layer = view.layer('gizmo');
  const nodes = new Map();
  let active = false;
  let mode = memory.get('gizmo.mode', 'move');
  let snaps = memory.get('gizmo.snap', false);
  let drag = null;
  const keys = gestures('gizmo');

  const modes = choiceOf({ label: 'Handles', choices: MODES, value: mode, radios: true, onchange: setMode });
  const snap = checkbox('Snap', snaps, setSnap);
  const along = checkbox('With contents', choice.group.on, (on) => choice.group.set(on));
  snap.node.title = say('Round to the steps of the panel Objects (N); Shift does the opposite while dragging a handle');
  along.node.title = say('Objects inside move with the object, such as the liquid and the rod of a vessel');
  modes.group.title = say('Handles of the selected object (G)');
  const options = element('div', { class: 'gizmo-options' }, modes.group, snap.node, along.node);
  options.addEventListener('pointerdown', (event) => event.stopPropagation());

  choice.on(draw);
  choice.group.onchange(draw);
  for (const name of ['view', 'scene', 'state']) lab.on(name, draw);
  return {
    show() {
      active = true;
      view.overlay.append(options); /* not in the toolbar, which would wrap and resize the image in a drag */
      draw();
    },
    hide() {
      active = false;
      options.remove();
      draw();
    },
    key,
    get snaps() {
      return snaps;
    },
    inSteps: (vector) => vector.map((x) => round(x, step())),
  };

  function step() {
    return memory.get('object.length', 0.1);
  }

  function round(x, to) {
    return Number((Math.round(x / to) * to).toPrecision(12));
  }

  function setMode(next) {
    finish();
    mode = next;
    modes.set(next);
    memory.set('gizmo.mode', next);
    draw();
  }

  function setSnap(on) {
    snaps = on;
    snap.set(on);
    memory.set('gizmo.snap', on);
  }

  function key(event) {
    const letter = event.key.toLowerCase();
    if (letter === 'g') {
      const at = MODES.findIndex(([name]) => name === mode);
      setMode(MODES[(at + (event.shiftKey ? 2 : 1)) % MODES.length][0]);
    } else if (letter === 'n') setSnap(!snaps);
    else return false;
    return true;
  }

  /* --- drawing --- */

  function turns() {
    const { object } = choice;
    return object?.kind === 'solid' || object?.light !== 'point';
  }

  /* During a drag the scene of the page lags behind. */
  function place() {
    return drag?.place || mark.at();
  }

  function draw() {
    const shown = active && movable(choice.object) && mark.at() && lab.state?.camera && view.width;
    along.node.hidden = !choice.group.names.length;
    const handles = shown && (mode !== 'turn' || turns()) ? handlesOf(lab, place(), mode) : [];
    for (const [name, node] of nodes)
      if (!handles.some((each) => each.name === name)) {
        node.remove();
        nodes.delete(name);
      }
    layer.replaceChildren(...handles.flatMap((handle) => lines(handle)));
    for (const handle of handles) put(handle);
  }

  function lines(handle) {
    const seen = (mode === 'turn' ? ringPoints(lab, place(), handle.axis) : [place(), handle.at]).map(view.project);
    if (seen.some((point) => !point)) return [];
    const points = seen.map(({ x, y }) => `${x.toFixed(2)},${y.toFixed(2)}`).join(' ');
    return ['edge', 'line'].map((what) => svg('polyline', { class: `gizmo-${what} ${handle.name}`, points }));
  }

  function put(handle) {
    if (!nodes.has(handle.name)) nodes.set(handle.name, create(handle.name));
    const node = nodes.get(handle.name);
    const seen = view.project(handle.at);
    const at = seen && view.toScreen(seen.x, seen.y);
    node.hidden = !at;
    if (!at) return;
    node.style.left = `${at.x}px`;
    node.style.top = `${at.y}px`;
    node.setAttribute('aria-label', handle.label);
    node.title = snaps
      ? say('{label}: drag, or use the arrow keys; Shift frees', handle)
      : say('{label}: drag, or use the arrow keys; Shift snaps', handle);
  }

  function create(name) {
    const node = element('button', { type: 'button', class: `gizmo-handle ${name}`, text: name === 'all' ? '' : name });
    node.addEventListener('pointerdown', (event) => begin(name, event));
    node.addEventListener('pointermove', (event) => drag?.name === name && follow(event));
    node.addEventListener('keydown', (event) => press(name, event));
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) node.addEventListener(end, finish);
    view.overlay.append(node);
    return node;
  }

  /* --- changes: the travel of the pointer since the drag began, part of which is already sent --- */

  function begin(name, event) {
    if (event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    event.currentTarget.focus({ preventScroll: true });
    const axis = AXES.indexOf(name);
    const start = mark.at();
    drag = {
      name,
      axis,
      mode,
      start,
      place: start,
      gesture: gesture('gizmo'),
      sent: mode === 'scale' ? 1 : 0,
      last: 0,
      end: dragging(cancel),
    };
    drag.from = measure(event);
    event.preventDefault();
    event.stopPropagation();
  }

  /* Along the axis in scene units, about it in degrees, or a distance from the centre in pixels. */
  function measure(event) {
    const point = view.fromEvent(event);
    if (drag.mode === 'move') return travelAlong(lab, drag.start, drag.axis, point);
    if (drag.mode === 'turn') return angleAbout(lab, drag.start, drag.axis, point);
    const centre = view.project(drag.start);
    return Math.max(1, Math.hypot(point.x - centre.x, point.y - centre.y));
  }

  function follow(event) {
    const now = measure(event);
    if (!Number.isFinite(now)) return;
    const rounded = event.shiftKey !== snaps;
    if (drag.mode === 'move') moveTo(now - drag.from, rounded);
    else if (drag.mode === 'turn') turnTo(now - drag.from, rounded);
    else scaleTo(now / drag.from, rounded);
  }

  /* Rounds the coordinate, not the distance. */
  function moveTo(distance, rounded) {
    const from = drag.start[drag.axis];
    const to = rounded ? round(from + distance, step()) - from : distance;
    const by = to - drag.sent;
    drag.sent = to;
    drag.place = drag.start.map((x, at) => (at === drag.axis ? x + to : x));
    if (by) choice.move(alongAxis(drag.axis, by), drag.gesture);
    draw();
  }

  /* The angle continues beyond half a turn. */
  function turnTo(angle, rounded) {
    const continued = angle + 360 * Math.round((drag.last - angle) / 360);
    drag.last = continued;
    const to = rounded ? round(continued, memory.get('object.angle', 15)) : continued;
    const by = to - drag.sent;
    drag.sent = to;
    if (by) choice.turn(alongAxis(drag.axis, by), drag.gesture);
  }

  function scaleTo(factor, rounded) {
    const to = rounded ? Math.max(SCALE_STEP, round(factor, SCALE_STEP)) : factor;
    const by = to / drag.sent;
    drag.sent = to;
    if (by !== 1) choice.scale(by, drag.gesture);
  }

  function finish() {
    drag?.end();
    drag = null;
  }

  function cancel() {
    takeBack(drag.gesture);
    drag = null;
    draw();
  }

  function press(name, event) {
    const sign = signs[event.key];
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (sign) {
      stepBy(AXES.indexOf(name), event.shiftKey ? sign * 0.1 : sign, keys.at(event.timeStamp, name));
    } else if (!key(event)) return;
    else [...nodes.values()][0]?.focus({ preventScroll: true }); /* the handles of the new mode */
    event.preventDefault();
    event.stopPropagation();
  }

  function stepBy(axis, count, series) {
    if (mode === 'move') choice.move(alongAxis(axis, count * step()), series);
    else if (mode === 'turn') choice.turn(alongAxis(axis, count * memory.get('object.angle', 15)), series);
    else choice.scale(memory.get('object.factor', 1.1) ** count, series);
  }
}

/* --- the positions of the handles, and the travel along or about an axis for a point of the image ---
 * Pure functions of the camera; vectors and lengths in scene units, image points in image pixels. */

const AXES = ['x', 'y', 'z'];
const ARM_PX = [30, 78]; /* limits of an arm's length, which is a quarter of the shorter side of the image */
const LEAST_PX = 16; /* an arrow that points at the eye cannot be dragged */
const LEAST_TILT = 0.15; /* below it a ring is seen from its edge, and its plane cannot be used */
const RING = 48;

const directions = AXES.map((_, axis) => AXES.map((__, at) => (at === axis ? 1 : 0)));

function armPixels({ view }) {
  const [least, most] = ARM_PX;
  return Math.min(most, Math.max(least, (Math.min(view.width, view.height) * view.scale) / 4));
}

/* The length of a handle's arm at that place. */
function armAt(lab, place) {
  const { camera } = lab.state;
  return unitsPerPixel(lab, Math.max(1e-9, dot(minus(place, camera.eye), camera.forward))) * armPixels(lab);
}

/* The ray of the camera through an image point: its origin and direction. */
function rayThrough(lab, { x, y }) {
  const { camera } = lab.state;
  const { width, height } = lab.view;
  const across = times(camera.right, ((2 * x) / width - 1) * camera.half_width);
  const upward = times(camera.up, (1 - (2 * y) / height) * camera.half_height);
  const aside = add(across, upward);
  return camera.parallel
    ? { eye: add(camera.eye, aside), ray: camera.forward }
    : { eye: camera.eye, ray: unit(add(camera.forward, aside)) };
}

/* The middle of the quarter of the ring that is nearest to the eye. */
function onRing(lab, place, axis, arm) {
  const towards = minus(lab.state.camera.eye, place);
  const [a, b] = [1, 2].map((next) => directions[(axis + next) % 3]);
  const sides = [a, b].map((side) => times(side, dot(side, towards) < 0 ? -Math.SQRT1_2 : Math.SQRT1_2));
  return add(place, times(add(...sides), arm));
}

function ringPoints(lab, place, axis) {
  const arm = armAt(lab, place);
  const [a, b] = [1, 2].map((next) => directions[(axis + next) % 3]);
  return Array.from({ length: RING + 1 }, (_, k) => {
    const angle = (2 * Math.PI * k) / RING;
    return add(place, add(times(a, arm * Math.cos(angle)), times(b, arm * Math.sin(angle))));
  });
}

function isLong(lab, from, to) {
  const [a, b] = [lab.view.project(from), lab.view.project(to)];
  return a && b && Math.hypot(a.x - b.x, a.y - b.y) * lab.view.scale >= LEAST_PX;
}

function handlesOf(lab, place, mode) {
  const arm = armAt(lab, place);
  const { right, up } = lab.state.camera;
  if (!lab.view.project(place)) return [];
  if (mode === 'scale')
    return [{ name: 'all', axis: -1, at: add(place, times(add(right, up), arm * Math.SQRT1_2)), label: say('Scale') }];
  const handles = AXES.map((name, axis) =>
    mode === 'turn'
      ? { name, axis, at: onRing(lab, place, axis, arm), label: say('Turn about {axis}', { axis: name }) }
      : { name, axis, at: add(place, times(directions[axis], arm)), label: say('Move along {axis}', { axis: name }) },
  );
  return handles.filter((each) => mode === 'turn' || isLong(lab, place, each.at));
}

/* The distance along the axis from `place` to the axis' point nearest to the ray of the pointer: the closest points of
 * two lines. */
function travelAlong(lab, place, axis, point) {
  const { eye, ray } = rayThrough(lab, point);
  const along = directions[axis];
  const from = minus(place, eye);
  const cosine = dot(ray, along);
  return (cosine * dot(ray, from) - dot(along, from)) / (1 - cosine * cosine);
}

/* The angle about the axis in degrees: of the point where the ray meets the ring's plane; for a ring seen from its
 * edge, from the movement across the screen. */
function angleAbout(lab, place, axis, point) {
  const { right, up } = lab.state.camera;
  const { eye, ray } = rayThrough(lab, point);
  const normal = directions[axis];
  const [a, b] = [1, 2].map((next) => directions[(axis + next) % 3]);
  const tilt = dot(ray, normal);
  if (Math.abs(tilt) > LEAST_TILT) {
    const d = minus(add(eye, times(ray, dot(minus(place, eye), normal) / tilt)), place);
    return (Math.atan2(dot(d, b), dot(d, a)) * 180) / Math.PI;
  }
  const seen = lab.view.project(place); /* the near side of the ring moves across its axis */
  const across = -(point.x - seen.x) * dot(normal, up) - (point.y - seen.y) * dot(normal, right);
  return ((across * lab.view.scale) / armPixels(lab)) * (180 / Math.PI);
}
