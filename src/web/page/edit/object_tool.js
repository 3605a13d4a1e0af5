/* The tool Object: a click in the image selects an object, dragging moves it parallel to the image plane at its depth,
 * with everything inside it; handles (object_gizmo.js) move, turn and scale it. An object without bounds (a plane) is
 * selected but not dragged: on it, on the background, and with Shift anywhere, dragging moves the current selection.
 * exports:
 *   objectTool(lab, choice, mark)
 *   createMark(lab, choice) -> {at() -> [x,y,z] or null}     the mark of the selected object over the image, while its
 *                                                            tool or panel is active */

import { takeBack } from '../shared/escape.js';
import { gesture, gestures, svg } from '../shared/ui.js';
import { add, dot, minus, spreadAt, times } from '../shared/vectors.js';
import { createWheelZoom } from '../view/camera_moves.js';
import { hull, solidPoints } from '../view/solids.js';
import { createGizmo } from './object_gizmo.js';

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
      'Take an object: click it, then drag it or its handles to move, turn or scale it ' +
      '(arrow keys; G: next handles; N: snap; Delete: remove)',
    chosen() {
      lab.panels?.select('edit');
      gizmo.show();
    },
    dropped: gizmo.hide,
    wheel: createWheelZoom(lab),
    down,
    move,
    up,
    cancel,
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

  function aimAtChosen(now) {
    const place = mark.at();
    if (moves(choice.object) && place) now.depth = depthOf(place);
  }

  function down(point, event) {
    if (!lab.state?.camera || (!point.inside && !choice.name)) return false;
    const now = (drag = {
      gesture: gesture('object'),
      chosen: choice.name,
      from: point,
      last: point,
      depth: 0,
      hit: null,
      far: false,
    });
    if (event.shiftKey || !point.inside) {
      aimAtChosen(now);
      return true;
    }
    hitAt(point).then((hit) => aim(now, hit));
    return true;
  }

  /* Meanwhile the pointer may have moved or been released. */
  async function aim(now, hit) {
    if (now.cancelled) return;
    now.hit = hit;
    const object = hit && lab.object(hit.solid);
    if (moves(object)) {
      choice.choose(hit.solid);
      await choice.group.ready;
      now.depth = depthOf(hit.point);
    } else if (!now.far && now.ended) {
      choice.choose(hit ? hit.solid : '');
    } else {
      aimAtChosen(now);
    }
    now.known = true;
    if (now.far) dragTo(now, now.last);
  }

  /* With snapping, the object moves in steps along each axis, counted from its position before the drag. */
  function dragTo(now, point) {
    if (!(now.depth > 0) || !choice.name || now.cancelled) return;
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
    if (drag.far) dragTo(drag, point);
  }

  function up() {
    const now = drag;
    drag = null;
    if (!now) return;
    now.ended = true;
    if (!now.far && now.known && !moves(lab.object(now.hit?.solid))) choice.choose(now.hit ? now.hit.solid : '');
  }

  function cancel() {
    drag.cancelled = true;
    takeBack(drag.gesture);
    choice.choose(drag.chosen);
    drag = null;
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

/* --- the mark: an outline, dashed outlines of what moves along, and a cross at the position ---
 * A solid without a cheap outline is marked by a ball around it. */

const CROSS_PX = 9;

export function createMark(lab, choice) {
  const { view } = lab;
  const layer = view.layer('object');
  choice.on(draw);
  choice.group.onchange(draw);
  for (const name of ['view', 'scene', 'state', 'panel', 'tool']) lab.on(name, draw);
  return { at };

  function at() {
    /* the place of what follows a solid is in that solid's frame */
    if (!choice.name || lab.param(`${choice.name}.follows`)?.value) return null;
    return lab.param(`${choice.name}.position`)?.value || null;
  }

  function draw() {
    const place = at();
    const visible = lab.panels?.chosen() === 'edit' || view.chosen === 'object';
    layer.replaceChildren(...(visible && place && lab.state?.camera ? [...marks(place), ...cross(place)] : []));
  }

  function stroked(tag, kind, attributes) {
    return ['edge', 'line'].map((what) => svg(tag, { class: `object-${what}${kind}`, ...attributes }));
  }

  function marks(place) {
    const solids = solidPoints(lab);
    const of = (name) => solids.find((each) => each.name === name);
    const chosen = of(choice.name) ? outline(of(choice.name), '') : ball(place);
    const along = choice.group.on ? choice.group.names.map(of).filter(Boolean) : [];
    return [...along.flatMap((solid) => outline(solid, ' along')), ...chosen];
  }

  /* The outlines of the solid's convex parts; a part that reaches behind the camera is omitted. */
  function outline(solid, kind) {
    return solid.points.flatMap((points) => {
      const seen = points.map((point) => view.project(point));
      if (seen.some((point) => !point)) return [];
      const around = hull(seen.map((point) => [point.x, point.y]));
      return stroked('polygon', kind, {
        points: around.map((point) => point.map((x) => x.toFixed(2)).join(',')).join(' '),
      });
    });
  }

  function ball(place) {
    const { centre, radius } = choice.group;
    const seen = centre && view.project(add(place, centre));
    if (!seen || seen.depth <= radius) return [];
    const { camera } = lab.state;
    const r = (radius / spreadAt(camera, seen.depth) / (2 * camera.half_width)) * view.width;
    return stroked('circle', ' ball', { cx: seen.x, cy: seen.y, r });
  }

  function cross(place) {
    const seen = view.project(place);
    if (!seen) return [];
    const arm = CROSS_PX / (view.scale || 1);
    return stroked('path', '', { d: `M${seen.x - arm} ${seen.y}h${2 * arm}M${seen.x} ${seen.y - arm}v${2 * arm}` });
  }
}
