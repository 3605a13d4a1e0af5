/* The mark of the selected object over the image, while its tool or panel is active: the outline of a simple solid,
 * and a cross at its position.
 * exports: createMark(lab, choice) -> {at() -> [x,y,z] or null} */

import { svg } from './ui.js';
import { hull, solidPoints } from './ray_solids.js';

const CROSS_PX = 9;

export function createMark(lab, choice) {
  const { view } = lab;
  const layer = view.layer('object');
  choice.on(draw);
  for (const name of ['view', 'scene', 'state', 'panel', 'tool']) lab.on(name, draw);
  return { at };

  function at() {
    return (choice.name && lab.param(`${choice.name}.position`)?.value) || null;
  }

  function draw() {
    const place = at();
    const visible = lab.panels?.chosen() === 'edit' || view.chosen === 'object';
    layer.replaceChildren(...(visible && place && lab.state?.camera ? [...outline(), ...cross(place)] : []));
  }

  function stroked(tag, attributes) {
    return ['edge', 'line'].map((what) => svg(tag, { class: `object-${what}`, ...attributes }));
  }

  /* Omitted if a part of it is behind the camera. */
  function outline() {
    const solid = solidPoints(lab).find((each) => each.name === choice.name);
    return (solid?.points || []).flatMap((points) => {
      const seen = points.map((point) => view.project(point));
      if (seen.some((point) => !point)) return [];
      const around = hull(seen.map((point) => [point.x, point.y]));
      return stroked('polygon', { points: around.map((point) => point.map((x) => x.toFixed(2)).join(',')).join(' ') });
    });
  }

  function cross(place) {
    const seen = view.project(place);
    if (!seen) return [];
    const arm = CROSS_PX / (view.scale || 1);
    return stroked('path', { d: `M${seen.x - arm} ${seen.y}h${2 * arm}M${seen.x} ${seen.y - arm}v${2 * arm}` });
  }
}
