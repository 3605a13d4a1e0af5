/* The tool Object: a click in the image selects an object, dragging moves it parallel to the image plane at its depth,
 * with everything inside it; handles (object_gizmo.js) move, turn and scale it. An object without bounds (a plane) is
 * selected but not dragged: on it, on the background, and with Shift anywhere, dragging moves the current selection.
 * exports: objectTool(lab, choice, mark) */

import { createWheelZoom } from './camera_moves.js';
import { createGizmo } from './object_gizmo.js';
import { gesture, gestures } from './ui.js';
import { add, dot, minus, spreadAt, times } from './ray_vectors.js';

const STILL_PX = 3; /* a shorter drag is a click */
const KEY_PX = 8; /* CSS pixels per key press */

export function objectTool(lab, choice, mark) {
  const { view } = lab;
  let drag = null;
  const keys = gestures('object');

  const isUnbounded = (object) => lab.scene.shapes.find((each) => each.shape === object.shape)?.unbounded;
  const moves = (object) => object && (object.kind === 'light' || (object.kind === 'solid' && !isUnbounded(object)));

  const gizmo = createGizmo(lab, choice, mark, (object) => moves(object));
  view.tool('object', {
    label: 'Object',
    icon: 'cube',
    order: 15,
    cursor: 'pointer',
    hint:
      'Click an object to select it, drag to move it; with Shift, drag the current ' +
      'selection; arrow keys move, Delete removes; handles move, turn and scale: G changes them, N snaps',
    chosen() {
      lab.panels?.use('edit');
      gizmo.show();
    },
    dropped: gizmo.hide,
    wheel: createWheelZoom(lab),
    down,
    move,
    up,
    key,
  });

  function depthOf(point) {
    const camera = lab.state.camera;
    return dot(minus(point, camera.eye), camera.forward);
  }

  /* The world-space offset for dx, dy image pixels at that depth. */
  function offset(dx, dy, depth) {
    const { camera } = lab.state;
    const { right, up: upward, half_width: w, half_height: h } = camera;
    const spread = spreadAt(camera, depth);
    const [across, down] = [((2 * w) / view.width) * spread, ((2 * h) / view.height) * spread];
    return add(times(right, dx * across), times(upward, -dy * down));
  }

  async function hitAt(point) {
    try {
      const tree = await lab.get(`/api/trace?x=${Math.floor(point.x)}&y=${Math.floor(point.y)}`);
      return tree.root?.hit || null;
    } catch (error) {
      if (error.status !== 409) lab.fail(error);
      return null;
    }
  }

  function takeChosen(now) {
    const place = mark.at();
    if (moves(choice.object) && place) now.depth = depthOf(place);
  }

  function down(point, event) {
    if (!lab.state?.camera || (!point.inside && !choice.name)) return false;
    const now = (drag = { gesture: gesture('object'), from: point, last: point, depth: 0, hit: null, far: false });
    if (event.shiftKey || !point.inside) {
      takeChosen(now);
      return true;
    }
    hitAt(point).then((hit) => take(now, hit, point));
    return true;
  }

  /* Meanwhile the pointer may have moved or been released. */
  async function take(now, hit) {
    now.hit = hit;
    const object = hit && lab.object(hit.solid);
    if (moves(object)) {
      choice.choose(hit.solid);
      await choice.group.ready;
      now.depth = depthOf(hit.point);
    } else if (!now.far && now.ended) {
      choice.choose(hit ? hit.solid : '');
    } else {
      takeChosen(now);
    }
    now.known = true;
    if (now.far) go(now, now.last);
  }

  /* With snapping, in whole steps along each axis from where the object was. */
  function go(now, point) {
    if (!(now.depth > 0) || !choice.name) return;
    const all = offset(point.x - now.from.x, point.y - now.from.y, now.depth);
    const to = gizmo.snaps ? gizmo.inSteps(all) : all;
    const by = minus(to, now.sent || [0, 0, 0]);
    now.sent = to;
    if (by.some((x) => x !== 0)) choice.move(by, now.gesture);
  }

  function move(point) {
    if (!drag) return;
    drag.last = point;
    drag.far ||= Math.hypot(point.x - drag.from.x, point.y - drag.from.y) * view.scale > STILL_PX;
    if (drag.far) go(drag, point);
  }

  function up() {
    const now = drag;
    drag = null;
    if (!now) return;
    now.ended = true;
    if (!now.far && now.known && !moves(lab.object(now.hit?.solid))) choice.choose(now.hit ? now.hit.solid : '');
  }

  function key(event) {
    const steps = { ArrowLeft: [-KEY_PX, 0], ArrowRight: [KEY_PX, 0], ArrowUp: [0, -KEY_PX], ArrowDown: [0, KEY_PX] };
    if (!choice.name) return false;
    if (event.key === 'Escape') choice.choose('');
    else if (event.key === 'Delete') choice.remove();
    else if (gizmo.key(event)) return true;
    else if (steps[event.key] && moves(choice.object) && mark.at()) {
      const fine = event.shiftKey ? 0.1 : 1;
      const [dx, dy] = steps[event.key];
      choice.move(
        offset((dx * fine) / view.scale, (dy * fine) / view.scale, Math.max(depthOf(mark.at()), 0)),
        keys.at(event.timeStamp),
      );
    } else return false;
    return true;
  }
}
