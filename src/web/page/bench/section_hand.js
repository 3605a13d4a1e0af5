/* The pointer and the keys in a section: objects are moved and turned in the plane, hits are chosen, the window is
 * scrolled and magnified. A drag is one step of Undo, and Escape takes it back.
 *
 * exports: createHand(lab, section, stage) -> {draw(), busy()}
 *   draw: the handles of the selected object and of the beams; busy: whether an object is being dragged */

import { say } from '../shared/language.js';
import { digits, gesture, gestures, svg } from '../shared/ui.js';
import { dot } from '../shared/vectors.js';
import { flat, placed, turnAbout } from './section_plane.js';

const ANGLE = 5; /* degrees: of the snap, and of a key */
const ARM_PX = 64; /* from an object to the handle that turns it */
const BEAM_ARM_PX = 88;
const PAN_PX = 48;
const ZOOM = 1.25;
const WHEEL = 1 / 400; /* logarithm of the scale per CSS pixel of the wheel */
const STILL_PX = 3;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

const nearest = (x, step) => Number((Math.round(x / step) * step).toPrecision(12));

export function createHand(lab, section, stage) {
  const { node: drawing, port, layers } = section;
  const nodes = new Map();
  const touches = new Map();
  const keys = gestures('section');
  let drag = null;
  let pinch = null;

  stage.addEventListener('pointerdown', down);
  stage.addEventListener('pointermove', move);
  for (const name of ['pointerup', 'pointercancel']) stage.addEventListener(name, up);
  stage.addEventListener('wheel', wheel, { passive: false });
  drawing.addEventListener('keydown', key);
  drawing.addEventListener('focusin', focus);
  drawing.addEventListener('pointerover', point);
  drawing.addEventListener('pointerleave', point);
  return { draw, busy: () => Boolean(drag?.name && drag.far) };

  /* --- what can be moved and turned --- */

  function placeOf(name) {
    return lab.param(`${name}.position`)?.value || null;
  }

  function isBeam(name) {
    return lab.object(name)?.kind === 'beam';
  }

  function movable(name) {
    const object = lab.object(name);
    if (!object || !placeOf(name)) return false;
    return !lab.scene.shapes.find((each) => each.shape === object.shape)?.unbounded;
  }

  /* The direction of an object's handle in the plane, in degrees from the right; null for a beam across the plane. */
  function directionOf(name) {
    const { plane } = section;
    const rows = ['direction', 'target', 'position'].map((row) => lab.param(`${name}.${row}`)?.value);
    const [direction, target, position] = rows;
    if (!isBeam(name)) return 90;
    const along = direction?.some(Boolean) ? direction : target?.map((x, axis) => x - position[axis]);
    if (!along) return null;
    const [u, v] = [dot(along, plane.right), dot(along, plane.up)];
    return Math.hypot(u, v) > 1e-9 ? (Math.atan2(v, u) * 180) / Math.PI : null;
  }

  /* Solids have no direction in the plane: their turns are counted from how they lie, if they lie straight. */
  function angleOf(name) {
    if (isBeam(name)) return directionOf(name);
    const axis = section.plane.normal.findIndex((x) => Math.abs(x) > 1 - 1e-9);
    const rotation = lab.param(`${name}.rotation`)?.value;
    if (axis < 0 || !rotation || rotation.some((x, at) => at !== axis && x !== 0)) return 0;
    const [sense] = turnAbout(section.plane, 1).filter(Boolean);
    return sense * rotation[axis];
  }

  /* --- the handles: elements stay while their object exists, so that the focus stays --- */

  function draw() {
    const { plane } = section;
    const wanted = [];
    /* A beam that follows a solid has its place in that solid's frame. */
    const free = (name) => placeOf(name) && !lab.param(`${name}.follows`)?.value;
    const beams = (lab.scene?.objects || []).filter(({ kind, name }) => kind === 'beam' && free(name));
    for (const { name } of beams) wanted.push(startOf(name));
    const chosen = lab.choice?.name;
    if (chosen && movable(chosen) && directionOf(chosen) !== null) wanted.push(turnOf(chosen));
    for (const [id, node] of nodes)
      if (!wanted.some((each) => each.id === id)) {
        node.remove();
        nodes.delete(id);
      }
    for (const each of wanted) put(each, plane);
  }

  function startOf(name) {
    const [u, v, away] = flat(section.plane, placeOf(name));
    const distance = digits(Math.abs(away), 3);
    const inPlane = Math.abs(away) * port.scale <= 1;
    const label = inPlane
      ? say('Start of {name}', { name })
      : say('Start of {name}, {distance} units away from this plane', { name, distance });
    return { id: `start ${name}`, name, turns: false, x: port.x(u), y: port.y(v), label };
  }

  function turnOf(name) {
    const [u, v] = flat(section.plane, placeOf(name));
    const turning = drag?.turns && drag.name === name ? drag.angle : null;
    const angle = ((turning ?? directionOf(name)) * Math.PI) / 180;
    const arm = isBeam(name) ? BEAM_ARM_PX : ARM_PX;
    const [x0, y0] = [port.x(u), port.y(v)];
    const [x, y] = [x0 + arm * Math.cos(angle), y0 - arm * Math.sin(angle)];
    return { id: `turn ${name}`, name, turns: true, x, y, from: [x0, y0], label: say('Turn {name}', { name }) };
  }

  function put({ id, name, turns, x, y, from, label }) {
    if (!nodes.has(id)) {
      const made = svg(
        'g',
        { class: `section-handle ${turns ? 'turn' : 'start'}`, tabindex: '0', role: 'button' },
        svg('path', { class: 'arm' }),
        svg('circle', { class: 'grip', r: 20 }),
        turns ? svg('circle', { class: 'knob', r: 7 }) : svg('path', { class: 'knob', d: 'M-7 -6L8 0L-7 6Z' }),
      );
      Object.assign(made.dataset, { name, turns: turns ? '1' : '' });
      nodes.set(id, made);
      layers.hand.append(made);
    }
    const node = nodes.get(id);
    node.setAttribute('transform', `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
    node.setAttribute('aria-label', label);
    node.classList.toggle('chosen', lab.choice?.name === name);
    const arm = from ? `M${(from[0] - x).toFixed(2)} ${(from[1] - y).toFixed(2)}L0 0` : '';
    node.querySelector('.arm').setAttribute('d', arm);
    if (!turns) node.querySelector('.knob').setAttribute('transform', `rotate(${-(directionOf(name) ?? 0)})`);
  }

  /* --- the pointer --- */

  function here(event) {
    const box = drawing.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  function down(event) {
    const at = here(event);
    touches.set(event.pointerId, at);
    if (touches.size === 2) return beginPinch();
    if (touches.size > 2 || (event.button !== 0 && event.button !== 1)) return undefined;
    const target = event.button === 0 ? event.target.closest('.section-handle, .section-solid, .section-hit') : null;
    const ray = event.button === 0 ? event.target.closest('.section-ray') : null;
    const name = target?.dataset.name || ray?.dataset.beam;
    const start = name && movable(name) ? placeOf(name) : null;
    drag = {
      id: event.pointerId,
      from: at,
      last: at,
      far: false,
      hit: target?.dataset.key,
      pick: name || '',
      name: start ? name : '',
      turns: Boolean(target?.dataset.turns),
      start: start && flat(section.plane, start),
      sent: [0, 0],
      gesture: gesture('section'),
    };
    if (drag.turns) Object.assign(drag, { angle: directionOf(name), base: angleOf(name), turned: 0, last0: 0 });
    if (name) lab.choice.choose(name);
    (target || drawing).focus({ preventScroll: true });
    stage.setPointerCapture(event.pointerId);
    event.preventDefault();
    return undefined;
  }

  function move(event) {
    const at = here(event);
    if (touches.has(event.pointerId)) touches.set(event.pointerId, at);
    if (pinch) return followPinch();
    if (!drag || event.pointerId !== drag.id) return undefined;
    const step = [at.x - drag.last.x, at.y - drag.last.y];
    drag.last = at;
    drag.far ||= Math.hypot(at.x - drag.from.x, at.y - drag.from.y) > STILL_PX;
    if (!drag.far) return undefined;
    const snaps = section.options.snap !== event.shiftKey;
    if (!drag.name) scroll(...step);
    else if (drag.turns) turnTo(at, snaps);
    else moveTo([(at.x - drag.from.x) / port.scale, (drag.from.y - at.y) / port.scale], snaps);
    return undefined;
  }

  function scroll(dx, dy) {
    if (!dx && !dy) return;
    port.pan(dx, dy);
    section.draw();
    section.ask();
  }

  /* The distance from the start of the drag, of which a part is already sent. */
  function moveTo([du, dv], snaps) {
    const [u, v] = drag.start;
    const to = snaps ? [nearest(u + du, section.steps.minor) - u, nearest(v + dv, section.steps.minor) - v] : [du, dv];
    const by = placed(section.plane, to[0] - drag.sent[0], to[1] - drag.sent[1]);
    drag.sent = to;
    if (by.some(Boolean)) lab.choice.move(by, drag.gesture).then(section.ask);
  }

  function turnTo({ x, y }, snaps) {
    const [u, v] = drag.start;
    const angle = (Math.atan2(port.y(v) - y, x - port.x(u)) * 180) / Math.PI;
    const from = (Math.atan2(port.y(v) - drag.from.y, drag.from.x - port.x(u)) * 180) / Math.PI;
    const free = angle - from + 360 * Math.round((drag.last0 - angle + from) / 360);
    drag.last0 = free;
    const to = snaps ? nearest(drag.base + free, ANGLE) - drag.base : free;
    const by = to - drag.turned;
    drag.turned = to;
    drag.angle = directionBefore(drag) + to;
    if (by) lab.choice.turn(turnAbout(section.plane, by), drag.gesture).then(section.ask);
    section.draw();
  }

  function directionBefore(now) {
    now.before ??= now.angle;
    return now.before;
  }

  function up(event) {
    touches.delete(event.pointerId);
    if (pinch && touches.size < 2) pinch = null;
    if (!drag || event.pointerId !== drag.id) return;
    const now = drag;
    drag = null;
    if (!now.far && now.hit) pin(now.hit);
    else if (!now.far && !now.pick) lab.choice.choose('');
    section.draw();
    section.ask();
  }

  /* What a cancelled drag has changed is one step of Undo. */
  async function cancel() {
    const now = drag;
    drag = null;
    if (now.name && (now.sent.some(Boolean) || now.turned)) {
      await lab.undo();
      lab.say('The drag is cancelled.');
    }
    section.draw();
    section.ask();
  }

  function pin(hit) {
    if (!section.pinned.delete(hit)) section.pinned.add(hit);
    section.draw();
  }

  /* A hit under the pointer or with the focus shows its angles. */
  function point(event) {
    const hit = event.type === 'pointerleave' ? null : event.target.closest('.section-hit')?.dataset.key;
    if (section.pointed === hit || drag) return;
    section.pointed = hit;
    section.draw();
  }

  function focus(event) {
    const { name, key: hit } = event.target.dataset || {};
    if (name && !drag) lab.choice.choose(name);
    if (hit) point(event);
  }

  function wheel(event) {
    const lines = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
    const { x, y } = here(event);
    port.zoom(Math.exp(-lines * WHEEL), x, y);
    section.draw();
    section.ask();
    event.preventDefault();
  }

  /* --- two fingers --- */

  function span() {
    const [a, b] = [...touches.values()];
    return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, size: Math.max(20, Math.hypot(a.x - b.x, a.y - b.y)) };
  }

  function beginPinch() {
    if (drag?.name && drag.far) cancel();
    drag = null;
    pinch = span();
  }

  function followPinch() {
    const now = span();
    port.zoom(now.size / pinch.size, pinch.x, pinch.y);
    port.pan(now.x - pinch.x, now.y - pinch.y);
    pinch = now;
    section.draw();
    section.ask();
  }

  /* --- keys --- */

  function key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const letter = event.key.toLowerCase();
    const { name, turns, key: hit } = event.target.dataset || {};
    const window = { '+': ZOOM, '=': ZOOM, '-': 1 / ZOOM }[event.key];
    const toggled = { a: 'angles', i: 'images', g: 'grid', n: 'snap' }[letter];
    if (event.key === 'Escape') escape();
    else if (window) {
      port.zoom(window);
      section.draw();
      section.ask();
    } else if (event.key === '0') section.fit();
    else if (toggled) section.set(toggled, !section.options[toggled]);
    else if (hit && (event.key === 'Enter' || event.key === ' ')) pin(hit);
    else if (ARROWS[event.key]) arrow(event, name || lab.choice?.name, turns);
    else if (letter === 'r') turnBy(name || lab.choice?.name, event.shiftKey ? -ANGLE : ANGLE, event);
    else if (event.key === 'Delete' && lab.choice?.name) lab.choice.remove();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  function escape() {
    if (drag) cancel();
    else if (lab.choice?.name) {
      lab.choice.choose('');
      drawing.focus({ preventScroll: true });
    } else section.close();
  }

  function arrow(event, name, turns) {
    const [du, dv] = ARROWS[event.key];
    if (!name || !movable(name)) return scroll(-du * PAN_PX, dv * PAN_PX);
    if (turns) return turnBy(name, (dv - du) * (event.shiftKey ? 1 : ANGLE), event);
    const step = section.steps.minor * (event.shiftKey ? 0.1 : 1);
    const [u, v] = flat(section.plane, placeOf(name));
    const snaps = section.options.snap && !event.shiftKey;
    const to = (x, sign) => (snaps ? nearest(x + sign * step, step) - x : sign * step);
    const by = placed(section.plane, du ? to(u, du) : 0, dv ? to(v, dv) : 0);
    return lab.choice.move(by, keys.at(event.timeStamp, 'move')).then(section.ask);
  }

  function turnBy(name, degrees, event) {
    if (!name || !movable(name)) return;
    const base = angleOf(name);
    const to = section.options.snap && Math.abs(degrees) === ANGLE ? nearest(base + degrees, ANGLE) - base : degrees;
    lab.choice.turn(turnAbout(section.plane, to), keys.at(event.timeStamp, 'turn')).then(section.ask);
  }
}
