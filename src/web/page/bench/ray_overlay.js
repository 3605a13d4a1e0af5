/* Draws the rays of a pixel over the image.
 *
 * exports:
 *   createRayOverlay(lab) -> {show(tree or null, pixel), draw(), mark(ray or null), nearest(point) -> ray or null,
 *                             count, omitted}
 *     draw: after a move of the camera; count: rays that are drawn; omitted: rays that are not, for their low weight
 *     or their number
 *   fraction(p, a, b)                  0..1 of the way from a to b, where a line in the image is nearest to a point
 *   distance(p, a, b)                  of a point from a line in the image
 *   drawn(tree) -> rays                the rays that drawings show
 *   WIDEST                             the width of the line of a ray with all its power */

import { svg } from '../shared/ui.js';
import { edged, inked, lineClass, seenLine } from './ray_tree.js';

const LIGHTEST = 0.002; /* weight below which rays are not drawn */
const LINES_MAX = 1500;
const NEAR_PX = 8; /* distance at which the pointer marks a ray */

export function drawn(tree) {
  const heavy = tree.rays.filter((ray) => ray.weight >= LIGHTEST);
  return heavy.length <= LINES_MAX ? heavy : heavy.sort((a, b) => b.weight - a.weight).slice(0, LINES_MAX);
}

export const WIDEST = 2.8;

export function createRayOverlay(lab) {
  const layer = lab.view.layer('pixel');
  let tree = null;
  let pixel = null;
  let pieces = []; /* {ray, a: [x, y], b: [x, y], node} */
  let marked = null;

  const overlay = {
    count: 0,
    omitted: 0,
    draw,
    mark,
    nearest,
    show(next, at) {
      tree = next;
      pixel = at;
      marked = null;
      draw();
    },
  };
  return overlay;

  function draw() {
    const rays = tree ? drawn(tree) : [];
    pieces = rays.map(piece).filter(Boolean);
    for (const one of pieces) {
      one.node = svg('line', {
        class: lineClass(one.ray),
        x1: one.a[0],
        y1: one.a[1],
        x2: one.b[0],
        y2: one.b[1],
      });
      inked(one.node, one.ray.weight, WIDEST);
    }
    overlay.count = rays.length;
    overlay.omitted = tree ? tree.rays.length - rays.length : 0;
    layer.replaceChildren(...pieces.map(halo), ...pieces.map((one) => one.node), ...(pixel ? [cross()] : []));
    const markedBefore = marked;
    marked = null;
    mark(markedBefore);
  }

  /* A dark edge makes the ray visible on any image. */
  function halo({ ray, a, b }) {
    const node = svg('line', { class: 'ray-halo', x1: a[0], y1: a[1], x2: b[0], y2: b[1] });
    return edged(node, ray.weight, WIDEST, 2);
  }

  /* The pixel itself with arms of 10 CSS pixels, at any zoom. */
  function cross() {
    const { x, y } = pixel;
    const arm = 10 / lab.view.scale;
    const d =
      `M${x} ${y}h1v1h-1zM${x + 0.5} ${y - arm}V${y}M${x + 0.5} ${y + 1}v${arm}M${x - arm} ` +
      `${y + 0.5}H${x}M${x + 1} ${y + 0.5}h${arm}`;
    return svg(
      'g',
      {},
      svg('path', { class: 'ray-halo', d, 'stroke-width': 4 }),
      svg('path', { class: 'ray-pixel', d }),
    );
  }

  function piece(ray) {
    const { view, state } = lab;
    const ends = state?.camera && view.width ? seenLine(ray.line, state.camera, view, view.frame()) : null;
    return ends && { ray, a: ends[0], b: ends[1] };
  }

  function mark(ray) {
    if (ray === marked) return;
    for (const one of pieces)
      if (one.ray === marked || one.ray === ray) one.node.classList.toggle('marked', one.ray === ray);
    marked = ray;
  }

  function nearest(point) {
    let best = null;
    let least = NEAR_PX / lab.view.scale;
    for (const { ray, a, b } of pieces) {
      const away = distance([point.x, point.y], a, b);
      if (away < least && ray.node.kind !== 'camera') [best, least] = [ray, away];
    }
    return best;
  }
}

export function fraction(p, a, b) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const size = dx * dx + dy * dy;
  return size ? Math.min(1, Math.max(0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / size)) : 0;
}

export function distance(p, a, b) {
  const t = fraction(p, a, b);
  return Math.hypot(p[0] - a[0] - t * (b[0] - a[0]), p[1] - a[1] - t * (b[1] - a[1]));
}
