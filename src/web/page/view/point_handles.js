/* Handles of points in the scene over the image, such as the lights' positions. Dragging or the arrow keys move a point
 * parallel to the image plane, with Shift along the line of sight.
 * exports:
 *   createPointHandles(lab, {list, symbol, what}) -> {show(), hide(), draw()}
 *     list() -> [{path, name}]: the parameters to move and their names; symbol: an icon; what: for screen readers
 *   lightTool(lab)     the tool Light: one handle per light */

import { dragging, takeBack } from '../shared/escape.js';
import { say, translated } from '../shared/language.js';
import { element, gesture, gestures, icon, vector } from '../shared/ui.js';
import { spreadAt } from '../shared/vectors.js';
import { createWheelZoom } from './camera_moves.js';

const EDGE = 30;
const KEY_PX = 12; /* CSS pixels per key press */

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const minus = (a, b) => a.map((value, axis) => value - b[axis]);

export function createPointHandles(lab, { list, symbol, what }) {
  const { view } = lab;
  const handles = new Map();
  let active = false;

  for (const name of ['view', 'scene', 'state', 'image']) lab.on(name, draw);
  return {
    show() {
      active = true;
      draw();
    },
    hide() {
      active = false;
      for (const handle of handles.values()) handle.node.remove();
      handles.clear();
    },
    draw,
  };

  function draw() {
    if (!active || !lab.state?.camera || !view.width) return;
    const points = list();
    for (const [path, handle] of handles)
      if (!points.some((point) => point.path === path)) {
        handle.node.remove();
        handles.delete(path);
      }
    for (const { path, name } of points) {
      if (!handles.has(path)) handles.set(path, createHandle(path, name));
      show(handles.get(path));
    }
  }

  function position(handle) {
    return handle.moved || lab.param(handle.path).value;
  }

  /* In CSS pixels of the stage; clamped to the image, with the direction for the arrow of a point outside. */
  function where(point) {
    const camera = lab.state.camera;
    const d = minus(point, camera.eye);
    const depth = dot(d, camera.forward);
    const seen = view.project(point);
    const upper = view.toScreen(0, 0);
    const lower = view.toScreen(view.width, view.height);
    const left = Math.max(upper.x, 0) + EDGE;
    const top = Math.max(upper.y, 0) + EDGE;
    const right = Math.min(lower.x, view.stage.clientWidth) - EDGE;
    const bottom = Math.min(lower.y, view.stage.clientHeight) - EDGE;
    if (seen) {
      const at = view.toScreen(seen.x, seen.y);
      const clamped = { x: Math.min(right, Math.max(left, at.x)), y: Math.min(bottom, Math.max(top, at.y)) };
      const outside = Math.hypot(clamped.x - at.x, clamped.y - at.y) > 1;
      return { ...clamped, outside, behind: false, angle: Math.atan2(at.y - clamped.y, at.x - clamped.x) };
    }
    const across = [dot(d, camera.right), -dot(d, camera.up)];
    const length = Math.hypot(...across) || 1;
    const middle = { x: (left + right) / 2, y: (top + bottom) / 2 };
    const direction = [across[0] / length, length > 1e-9 ? across[1] / length : 1];
    const reach = Math.min(
      (right - left) / 2 / Math.max(1e-9, Math.abs(direction[0])),
      (bottom - top) / 2 / Math.max(1e-9, Math.abs(direction[1])),
    );
    return {
      x: middle.x + direction[0] * reach,
      y: middle.y + direction[1] * reach,
      outside: true,
      behind: depth <= 0,
      angle: Math.atan2(direction[1], direction[0]),
    };
  }

  function show(handle) {
    const point = position(handle);
    const at = where(point);
    handle.node.style.left = `${at.x}px`;
    handle.node.style.top = `${at.y}px`;
    handle.node.style.setProperty('--direction', `${at.angle}rad`);
    handle.node.classList.toggle('outside', at.outside);
    handle.node.classList.toggle('low', at.outside && at.y > view.stage.clientHeight / 2);
    handle.node.classList.toggle('left', at.outside && at.x < 90);
    handle.node.classList.toggle('right', at.outside && at.x > view.stage.clientWidth - 90);
    const showPosition = handle.drag || document.activeElement === handle.node;
    handle.label.textContent = showPosition ? `${handle.name}  ${vector(point, 3)}` : handle.name;
    const about = { name: handle.name, place: vector(point, 3), what: translated(what) };
    const side = at.behind
      ? say('{name}  {place}, {what}, behind the camera', about)
      : at.outside
        ? say('{name}  {place}, {what}, outside the image', about)
        : say('{name}  {place}, {what}', about);
    handle.node.setAttribute('aria-label', side);
  }

  /* The world-space offset for dx, dy CSS pixels in the image at the point's own depth, so that the point stays
   * under the pointer. A point outside the image may be very near or behind the camera, so at least the target's
   * depth is used for it. */
  function along(point, dx, dy, { deep, seen }) {
    const camera = lab.state.camera;
    const depth = Math.max(dot(minus(point, camera.eye), camera.forward), seen ? 0 : camera.distance || 1);
    const spread = spreadAt(camera, depth);
    const x = (((dx / view.scale) * camera.half_width * 2) / view.width) * spread;
    const y = (((-dy / view.scale) * camera.half_height * 2) / view.height) * spread;
    return point.map(
      (value, axis) => value + (deep ? y * camera.forward[axis] : x * camera.right[axis] + y * camera.up[axis]),
    );
  }

  function move(handle, point, name) {
    const tidy = point.map((x) => Number(x.toPrecision(5)));
    handle.moved = tidy;
    show(handle);
    const mine = (handle.turn = (handle.turn || 0) + 1);
    lab
      .set({ [handle.path]: tidy }, name)
      .catch(lab.fail)
      .finally(() => {
        const end = lab.on('scene', () => {
          if (!handle.drag && handle.turn === mine) handle.moved = null;
          end();
        });
      });
  }

  function createHandle(path, name) {
    const handle = { path, name, moved: null, drag: null, keys: gestures('point') };
    handle.label = element('span', { class: 'point-name', translate: 'no', text: name });
    handle.node = element(
      'button',
      {
        type: 'button',
        class: 'point-handle',
        title: say('{name}: drag or use the arrow keys; with Shift: nearer and farther', { name }),
        onfocus: () => show(handle),
        onblur: () => show(handle),
      },
      icon(symbol),
      handle.label,
    );
    handle.node.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      handle.node.setPointerCapture(event.pointerId);
      handle.node.focus({ preventScroll: true });
      handle.drag = {
        x: event.clientX,
        y: event.clientY,
        at: position(handle),
        seen: !where(position(handle)).outside,
        gesture: gesture('point'),
        end: dragging(cancel),
      };
      event.preventDefault();
      event.stopPropagation();
    });
    handle.node.addEventListener('pointermove', (event) => {
      if (!handle.drag) return;
      const next = along(handle.drag.at, event.clientX - handle.drag.x, event.clientY - handle.drag.y, {
        deep: event.shiftKey,
        seen: handle.drag.seen,
      });
      Object.assign(handle.drag, { x: event.clientX, y: event.clientY, at: next });
      move(handle, next, handle.drag.gesture);
    });
    const cancel = () => {
      takeBack(handle.drag.gesture);
      Object.assign(handle, { drag: null, moved: null });
      show(handle);
    };
    const end = () => {
      handle.drag?.end();
      handle.drag = null;
    };
    handle.node.addEventListener('pointerup', end);
    handle.node.addEventListener('pointercancel', end);
    handle.node.addEventListener('keydown', (event) => {
      const offset = {
        ArrowLeft: [-KEY_PX, 0],
        ArrowRight: [KEY_PX, 0],
        ArrowUp: [0, -KEY_PX],
        ArrowDown: [0, KEY_PX],
      }[event.key];
      if (!offset || event.ctrlKey || event.altKey) return;
      move(
        handle,
        along(position(handle), ...offset, { deep: event.shiftKey, seen: !where(position(handle)).outside }),
        handle.keys.at(event.timeStamp),
      );
      event.preventDefault();
      event.stopPropagation();
    });
    view.overlay.append(handle.node);
    return handle;
  }
}

export function lightTool(lab) {
  const handles = createPointHandles(lab, { list, symbol: 'light', what: 'light' });
  lab.view.tool('light', {
    label: 'Light',
    icon: 'light',
    order: 20,
    cursor: 'default',
    hint: 'Move a lamp: drag it, or use Tab and the arrow keys. Shift: nearer and farther',
    wheel: createWheelZoom(lab),
    chosen: handles.show,
    dropped: handles.hide,
  });

  function list() {
    return (lab.scene?.objects || [])
      .filter((object) => object.kind === 'light' && lab.param(`${object.name}.position`))
      .map(({ name }) => ({ path: `${name}.position`, name }));
  }
}
