/* Where a new thing of the bench goes: the plane, what is there already, and where light runs. It is the plane of the
 * section; while the image is shown, the horizontal plane of the beams, or that through the camera's target.
 *
 * exports: sizeOf(lab, section) -> a suitable size of a new thing, a round number of scene units
 *          glassPlane(lab) -> {view, at} of a section through the middle of the largest transparent solid, for a scene
 *          without beams: along the axis of a prism, else with the axis in it; null without such a solid
 *          placeOf(lab, section) -> promise of
 *   {plane, window: [u0, u1, v0, v1], size, taken: [[u0, u1, v0, v1], ..], lines: [[[u, v], [u, v]], ..]}
 *     taken: boxes around the solids in the plane; lines: strong rays in it */

import { hull, isClear, solidPoints, turned } from '../view/solids.js';
import { dot, spreadAt } from '../shared/vectors.js';
import { flat } from './section_plane.js';
import { flatLine } from './ray_tree.js';
import { segmentsOf } from './rays.js';

const PART = 0.22; /* of the height of the window */
const STRONG = 0.2; /* of the power of a ray at its start */
const IN_PLANE = 0.02; /* distance from the plane, in heights of the window */

const roundSize = (size) => {
  const power = 10 ** Math.floor(Math.log10(size));
  return [5, 2, 1].map((factor) => factor * power).find((step) => step <= size * 1.05);
};

export function glassPlane(lab) {
  const sized = solidPoints(lab)
    .filter(({ name }) => isClear(lab, name))
    .map(({ name, points }) => {
      const sides = [0, 1, 2].map((axis) => {
        const values = points.flat().map((point) => point[axis]);
        return [values.reduce((a, b) => Math.min(a, b)), values.reduce((a, b) => Math.max(a, b))];
      });
      return { name, sides, volume: sides.reduce((product, [a, b]) => product * (b - a), 1) };
    });
  if (!sized.length) return null;
  const { name, sides } = sized.reduce((best, each) => (each.volume > best.volume ? each : best));
  const axis = turned([0, 1, 0], lab.param(`${name}.rotation`)?.value || [0, 0, 0]).map(Math.abs);
  const main = axis.indexOf(Math.max(...axis));
  const view = lab.object(name).shape === 'prism' ? ['side', 'top', 'front'][main] : main === 2 ? 'top' : 'front';
  const [low, high] = sides[{ side: 0, top: 1, front: 2 }[view]];
  return { view, at: Number(((low + high) / 2).toPrecision(6)) };
}

/* Of the window, or of what the camera sees at its target. */
function heightOf(lab, section) {
  if (section.shown && section.plane) return section.port.height / section.port.scale;
  const { camera, view } = lab.state;
  return 2 * camera.half_height * spreadAt(camera, view?.distance || camera.distance || 1);
}

export const sizeOf = (lab, section) => (lab.state?.camera ? roundSize(PART * heightOf(lab, section)) : 1);

function ofImage(lab, segments, height) {
  const { camera, view } = lab.state;
  const middle = view?.pivot || camera.target || [0, 0, 0];
  const first = segments.find(({ line }) => Math.abs(line.along[1]) < 1e-6);
  const at = first ? first.line.from[1] : middle[1];
  const plane = { origin: [0, at, 0], right: [1, 0, 0], up: [0, 0, 1], normal: [0, -1, 0] };
  const [half, deep] = [0.5 * height * Math.min(1.5, camera.half_width / camera.half_height), 0.4 * height];
  const [u, , v] = middle;
  return { plane, window: [u - half, u + half, v - deep, v + deep] };
}

export async function placeOf(lab, section) {
  const segments = (await lab.get('/api/beams')).beams.flatMap(segmentsOf);
  const height = heightOf(lab, section);
  const { plane, window } =
    section.shown && section.plane
      ? { plane: section.plane, window: section.port.extent() }
      : ofImage(lab, segments, height);
  const near = IN_PLANE * height;
  const frame = { left: window[0], right: window[1], bottom: window[2], top: window[3] };
  const lines = segments
    .filter(({ one, line }) => {
      const reach = Number.isFinite(line.end) ? line.end : height;
      const away = Math.abs(flat(plane, line.from)[2]) + Math.abs(dot(line.along, plane.normal)) * reach;
      return one.weight >= STRONG && away <= near;
    })
    .map(({ line }) => flatLine(line, { u: plane.right, v: plane.up }, frame))
    .filter(Boolean);
  return { plane, window, size: sizeOf(lab, section), taken: takenBy(lab, plane), lines };
}

/* Of solids that reach through the plane. */
function takenBy(lab, plane) {
  return solidPoints(lab)
    .flatMap(({ points }) => points)
    .map((points) => points.map((point) => flat(plane, point)))
    .filter((points) => points.some(([, , w]) => w < -1e-9) && points.some(([, , w]) => w > 1e-9))
    .map((points) => {
      const around = hull(points.map(([u, v]) => [u, v]));
      const [us, vs] = [0, 1].map((k) => around.map((point) => point[k]));
      return [Math.min(...us), Math.max(...us), Math.min(...vs), Math.max(...vs)];
    });
}
