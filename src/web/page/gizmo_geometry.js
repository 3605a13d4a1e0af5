/* Where the handles of an object are, and what a pointer at a point of the image means for them. Pure functions of the
 * camera; vectors and lengths in scene units, image points in image pixels.
 * exports: AXES; handlesOf(lab, place, mode) -> [{name, axis, at, label}]; ringPoints(lab, place, axis);
 *          travelAlong(lab, place, axis, point), angleAbout(lab, place, axis, point): NaN where the point means
 * nothing */

import { unitsPerPixel } from './camera_moves.js';
import { add, dot, minus, times, unit } from './ray_vectors.js';

export const AXES = ['x', 'y', 'z'];
const ARM_PX = [30, 78]; /* a quarter of a small image */
const LEAST_PX = 16; /* an arrow that points at the eye cannot be dragged */
const LEAST_TILT = 0.15; /* of a ring seen from its edge; its plane is then no use */
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

/* In the middle of the quarter of the ring that is nearest to the eye. */
function onRing(lab, place, axis, arm) {
  const towards = minus(lab.state.camera.eye, place);
  const [a, b] = [1, 2].map((next) => directions[(axis + next) % 3]);
  const sides = [a, b].map((side) => times(side, dot(side, towards) < 0 ? -Math.SQRT1_2 : Math.SQRT1_2));
  return add(place, times(add(...sides), arm));
}

export function ringPoints(lab, place, axis) {
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

export function handlesOf(lab, place, mode) {
  const arm = armAt(lab, place);
  const { right, up } = lab.state.camera;
  if (!lab.view.project(place)) return [];
  if (mode === 'scale')
    return [{ name: 'all', axis: -1, at: add(place, times(add(right, up), arm * Math.SQRT1_2)), label: 'Scale' }];
  const handles = AXES.map((name, axis) =>
    mode === 'turn'
      ? { name, axis, at: onRing(lab, place, axis, arm), label: `Turn about ${name}` }
      : { name, axis, at: add(place, times(directions[axis], arm)), label: `Move along ${name}` },
  );
  return handles.filter((each) => mode === 'turn' || isLong(lab, place, each.at));
}

/* The point of the axis that is nearest to the ray of the pointer: the closest points of two lines. */
export function travelAlong(lab, place, axis, point) {
  const { eye, ray } = rayThrough(lab, point);
  const along = directions[axis];
  const from = minus(place, eye);
  const cosine = dot(ray, along);
  return (cosine * dot(ray, from) - dot(along, from)) / (1 - cosine * cosine);
}

/* Where the ray meets the ring's plane; from its edge, the way across the screen is the way around. */
export function angleAbout(lab, place, axis, point) {
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
  const way = -(point.x - seen.x) * dot(normal, up) - (point.y - seen.y) * dot(normal, right);
  return ((way * lab.view.scale) / armPixels(lab)) * (180 / Math.PI);
}
