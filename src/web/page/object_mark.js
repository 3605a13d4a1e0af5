/* The mark of the selected object over the image, while its tool or panel is active: its outline, dashed outlines of
 * what moves along with it, and a cross at its position. A solid without a cheap outline is marked by a ball around it.
 * exports: createMark(lab, choice) -> {at() -> [x,y,z] or null} */

import { svg } from './ui.js';
import { hull, solidPoints } from './ray_solids.js';
import { add, spreadAt } from './ray_vectors.js';

const CROSS_PX = 9;

export function createMark(lab, choice) {
  const { view } = lab;
  const layer = view.layer('object');
  choice.on(draw);
  choice.group.onchange(draw);
  for (const name of ['view', 'scene', 'state', 'panel', 'tool']) lab.on(name, draw);
  return { at };

  function at() {
    return (choice.name && lab.param(`${choice.name}.position`)?.value) || null;
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
    const own = of(choice.name) ? outline(of(choice.name), '') : ball(place);
    const along = choice.group.on ? choice.group.names.map(of).filter(Boolean) : [];
    return [...along.flatMap((solid) => outline(solid, ' along')), ...own];
  }

  /* Omitted if a part of it is behind the camera. */
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
