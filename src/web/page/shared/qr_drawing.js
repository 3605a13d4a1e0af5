/* The drawing of a QR code. exports: qrDrawing(code of qr.js) -> an SVG element, black on white */

import { svg } from './elements.js';

const QUIET = 4;

export function qrDrawing(code) {
  const { size, dark } = code;
  const runs = [];
  for (let y = 0; y < size; y++)
    for (let x = 0; x < size; x++) {
      if (!dark(x, y) || (x > 0 && dark(x - 1, y))) continue;
      let end = x;
      while (end < size && dark(end, y)) end += 1;
      runs.push(`M${x + QUIET} ${y + QUIET}h${end - x}v1h${x - end}z`);
    }
  const room = size + 2 * QUIET;
  return svg(
    'svg',
    { class: 'qr', viewBox: `0 0 ${room} ${room}`, role: 'img', 'shape-rendering': 'crispEdges' },
    svg('rect', { width: room, height: room, fill: '#fff' }),
    svg('path', { d: runs.join(''), fill: '#000' }),
  );
}
