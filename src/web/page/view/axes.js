/* The directions of the world's axes, in a corner of the image: x to the right, y up, z away from the first camera. An
 * axis that points towards the viewer ends in a ring, any other in a dot; nearer axes are drawn over farther ones.
 * exports: createAxes(lab) -> node */

import { svg } from '../shared/ui.js';

const NAMES = ['x', 'y', 'z'];
const HALF = 34; /* of the drawing, in pixels; all below too */
const LENGTH = 19;

export function createAxes(lab) {
  const node = svg('svg', {
    class: 'view-axes',
    viewBox: [-HALF, -HALF, 2 * HALF, 2 * HALF].join(' '),
    'aria-hidden': 'true',
  });
  let drawn = '';
  lab.on('state', draw);
  return node;

  function draw() {
    const camera = lab.state?.camera;
    const seen =
      camera &&
      NAMES.map((name, k) => ({
        name,
        x: camera.right[k],
        y: -camera.up[k],
        depth: camera.forward[k],
      }));
    const text = JSON.stringify(seen ?? null);
    if (text === drawn) return;
    drawn = text;
    node.replaceChildren(...(seen ?? []).sort((a, b) => b.depth - a.depth).map(axis));
  }
}

function axis({ name, x, y, depth }) {
  const size = Math.hypot(x, y);
  const [tipX, tipY] = [LENGTH * x, LENGTH * y];
  const aside = size < 0.5; /* along the view, where another axis may end nearby */
  const label = aside ? [tipX + 10, tipY + 2] : [tipX + (8 * x) / size, tipY + (8 * y) / size];
  return svg(
    'g',
    { class: `axis-${name}` },
    svg('line', { x1: 0, y1: 0, x2: tipX, y2: tipY }),
    svg('circle', { cx: tipX, cy: tipY, r: 2.5, class: depth < -0.1 ? 'near' : 'far' }),
    svg('text', { x: label[0], y: label[1] + 4 }, name),
  );
}
