/* Outlines of transparent solids over the image, by a switch: glass before a plain background is hard to see.
 * exports: glassOutline(lab) */

import { button, memory, svg, write } from '../shared/ui.js';
import { hull, isClear, solidRings } from './solids.js';

const STRAIGHT = 12; /* corners: a part with more is drawn as a round one */

export function glassOutline(lab) {
  const { view } = lab;
  const layer = view.layer('glass');
  let on = memory.get('view.glass', false);
  const toggle = button('Outlines of glass', () => set(!on), {
    icon: 'cube',
    bare: true,
    kind: 'quiet',
    small: true,
    title: 'Draw the outlines of transparent solids over the image',
    pressed: on,
  });
  view.bar.prepend(toggle);
  for (const name of ['view', 'scene', 'state']) lab.on(name, draw);

  function set(now) {
    on = now;
    memory.set('view.glass', on);
    write(toggle, { ariaPressed: String(on) });
    draw();
  }

  function draw() {
    if (!on && !layer.firstChild) return;
    const shown = on && lab.state?.camera && lab.scene;
    const solids = shown ? solidRings(lab).filter(({ name }) => isClear(lab, name)) : [];
    layer.replaceChildren(...solids.flatMap(({ parts }) => parts.flatMap(outline)));
  }

  /* A part that reaches behind the camera has no outline. */
  function outline(rings) {
    const seen = rings.map(({ corners, points }) => ({ corners, points: points.map((point) => view.project(point)) }));
    if (seen.some(({ points }) => points.some((point) => !point))) return [];
    const all = seen.flatMap(({ points }) => points.map(({ x, y }) => [x, y]));
    const d = [closed(hull(all)), ...edges(seen)].join('');
    return ['glass-edge', 'glass-line'].map((name) => svg('path', { class: name, d }));
  }

  /* The ends of a part, and the straight edges between them. */
  function edges(rings) {
    const ends = [rings[0], rings[rings.length - 1]].map(({ points }) => points.map(({ x, y }) => [x, y]));
    const { corners } = rings[0];
    const sides =
      corners && corners <= STRAIGHT && rings.length === 2
        ? ends[0].map((point, k) => `M${point.map(tenths)}L${ends[1][k].map(tenths)}`)
        : [];
    return [...ends.map(closed), ...sides];
  }
}

const tenths = (x) => x.toFixed(1);
const closed = (points) => `M${points.map((point) => point.map(tenths).join(' ')).join('L')}Z`;
