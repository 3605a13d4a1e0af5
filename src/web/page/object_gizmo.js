/* Handles of the selected object over the image, while the tool Object is active: arrows that move it along the world's
 * axes, rings that turn it about them, and a handle that scales it. Each handle is a button: dragging it or its arrow
 * keys change the object. Shift while dragging, or the switch Snap, rounds to the steps of the panel Objects.
 * exports: createGizmo(lab, choice, mark, movable(object)) -> {show(), hide(), key(event), snaps, inSteps(vector)} */

import { check, choice as choiceOf, element, gesture, gestures, memory, svg } from './ui.js';
import { AXES, angleAbout, handlesOf, ringPoints, travelAlong } from './gizmo_geometry.js';

const MODES = [
  ['move', 'Move'],
  ['turn', 'Turn'],
  ['scale', 'Scale'],
];
const SCALE_STEP = 0.1;
const signs = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 };

const unit = (axis, length) => AXES.map((_, at) => (at === axis ? length : 0));

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
  const snap = check('Snap', snaps, setSnap);
  const along = check('With contents', choice.group.on, (on) => choice.group.set(on));
  snap.node.title = 'Round to the steps of the panel Objects (N); Shift does the contrary while dragging a handle';
  along.node.title = 'What is inside the object goes with it: the liquid and the rod of a vessel';
  modes.group.title = 'Handles of the selected object (G)';
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
    node.title = `${handle.label}: drag, or use the arrow keys; Shift ${snaps ? 'frees' : 'snaps'}`;
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

  /* --- changes: how far the pointer has gone since the drag began, of which a part is already sent --- */

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

  /* The coordinate is rounded, not the way. */
  function moveTo(way, rounded) {
    const from = drag.start[drag.axis];
    const to = rounded ? round(from + way, step()) - from : way;
    const by = to - drag.sent;
    drag.sent = to;
    drag.place = drag.start.map((x, at) => (at === drag.axis ? x + to : x));
    if (by) choice.move(unit(drag.axis, by), drag.gesture);
    draw();
  }

  /* Angles are continued past half a turn. */
  function turnTo(angle, rounded) {
    const whole = angle + 360 * Math.round((drag.last - angle) / 360);
    drag.last = whole;
    const to = rounded ? round(whole, memory.get('object.angle', 15)) : whole;
    const by = to - drag.sent;
    drag.sent = to;
    if (by) choice.turn(unit(drag.axis, by), drag.gesture);
  }

  function scaleTo(factor, rounded) {
    const to = rounded ? Math.max(SCALE_STEP, round(factor, SCALE_STEP)) : factor;
    const by = to / drag.sent;
    drag.sent = to;
    if (by !== 1) choice.scale(by, drag.gesture);
  }

  function finish() {
    drag = null;
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
    if (mode === 'move') choice.move(unit(axis, count * step()), series);
    else if (mode === 'turn') choice.turn(unit(axis, count * memory.get('object.angle', 15)), series);
    else choice.scale(memory.get('object.factor', 1.1) ** count, series);
  }
}
