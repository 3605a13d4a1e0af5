/* A small orthographic drawing of a pixel's rays, from the side or from above; both axes at one scale, in scene
 * units.
 * exports: createRayPlot({title, onmark(ray or null), onchoose(ray)}) -> {node, show(tree or null, plane, solids),
 * mark(ray or null)}
 *          sidePlane(camera), topPlane()     {u: [x,y,z], v: [x,y,z], uName, vName}: the axes to the right and up */

import { say } from '../shared/language.js';
import { digits, element, svg, unique } from '../shared/ui.js';
import { dot, unit } from '../shared/vectors.js';
import { hull } from '../view/solids.js';
import { drawn, WIDEST } from './ray_overlay.js';
import { flatLine, inked, lineClass, pointAt } from './ray_tree.js';

const WIDTH = 250;
const HEIGHT = 220;
const FRAME = { left: 32, top: 8, right: 8, bottom: 32 };

export const topPlane = () => ({ u: [1, 0, 0], v: [0, 0, 1], uName: 'x', vName: 'z' });

/* The vertical plane through the line of sight; for a camera that looks straight up or down, through its up vector. */
export function sidePlane(camera) {
  const level = ([x, , z]) => unit(Math.hypot(x, z) > 1e-6 ? [x, 0, z] : [0, 0, 0]);
  const u = (camera && (level(camera.forward) || level(camera.up))) || [0, 0, 1];
  const isZ = Math.abs(u[2]) > 1 - 1e-9;
  return { u: isZ ? [0, 0, 1] : u, v: [0, 1, 0], uName: isZ ? 'z' : 'along the line of sight', vName: 'y' };
}

export function createRayPlot({ title, onmark, onchoose }) {
  const drawing = svg('svg', {
    class: 'ray-plot',
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    role: 'img',
    'aria-label': title,
  });
  const node = element('figure', { class: 'ray-figure' }, drawing, element('figcaption', { text: title }));
  let lines = new Map();
  let marked = null;
  const rayAt = (event) => [...lines].find(([, line]) => line === event.target)?.[0];
  drawing.addEventListener('pointerover', (event) => {
    if (rayAt(event)) onmark(rayAt(event));
  });
  drawing.addEventListener('click', (event) => {
    if (rayAt(event)) onchoose(rayAt(event));
  });
  drawing.addEventListener('pointerleave', () => onmark(null));
  return { node, show, mark };

  function show(tree, plane, solids) {
    lines = new Map();
    marked = null;
    drawing.replaceChildren();
    if (!tree) return;
    const flat = (point) => [dot(point, plane.u), dot(point, plane.v)];
    const outlines = solids.map((solid) => ({ ...solid, parts: solid.points.map((points) => hull(points.map(flat))) }));
    const rays = drawn(tree);
    const map = fit(windowOf(rays, outlines, flat, tree.reach));
    const inside = unique('plot');
    drawing.append(
      svg('clipPath', { id: inside }, svg('rect', map.frame)),
      axes(map, plane),
      svg(
        'g',
        { 'clip-path': `url(#${inside})` },
        outlines.flatMap((solid) => outline(solid, map)),
        rays.flatMap((ray) => line(ray, plane, map)),
      ),
    );
  }

  function outline(solid, map) {
    return solid.parts.map((points) =>
      svg('path', { class: 'ray-solid', d: `M${points.map(map.at).join('L')}Z` }, svg('title', {}, solid.name)),
    );
  }

  function line(ray, plane, map) {
    const ends = flatLine(ray.line, plane, map.window);
    if (!ends) return [];
    const [a, b] = ends.map(map.at);
    const one = svg('line', {
      class: lineClass(ray),
      x1: a[0],
      y1: a[1],
      x2: b[0],
      y2: b[1],
    });
    inked(one, ray.weight, WIDEST);
    lines.set(ray, one);
    return [one];
  }

  function mark(ray) {
    lines.get(marked)?.classList.remove('marked');
    lines.get(ray)?.classList.add('marked');
    marked = ray;
  }
}

/* The bounds of the rays' hits, of the solids there, and of the camera if it is near. */
function windowOf(rays, outlines, flat, reach) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  const include = ([u, v], into = box) =>
    into.splice(0, 4, Math.min(into[0], u), Math.min(into[1], v), Math.max(into[2], u), Math.max(into[3], v));
  const size = (of) => (of[0] <= of[2] ? Math.hypot(of[2] - of[0], of[3] - of[1]) : 0);
  const hit = new Set(rays.filter((ray) => ray.node.hit).flatMap(({ node }) => [node.hit.solid, node.hit.surface_of]));
  for (const solid of outlines) if (hit.has(solid.name)) solid.parts.flat().forEach((point) => include(point));
  const near = size(box);
  for (const ray of rays) {
    const { hit } = ray.node;
    if (hit && (near === 0 || within(flat(hit.point), box, near))) include(flat(hit.point));
    if (!hit && !ray.parent) include(flat(pointAt(ray.line, 0.5 * reach)));
  }
  const wide = [...box];
  include(flat(rays[0].line.from), wide);
  return near === 0 || size(wide) < 4 * size(box) ? wide : box;
}

const within = ([u, v], box, reach) =>
  u > box[0] - reach && u < box[2] + reach && v > box[1] - reach && v < box[3] + reach;

/* Maps a point (u, v) of the box to the frame. */
function fit(box) {
  const frame = {
    x: FRAME.left,
    y: FRAME.top,
    width: WIDTH - FRAME.left - FRAME.right,
    height: HEIGHT - FRAME.top - FRAME.bottom,
  };
  const across = Math.max(1e-9, box[2] - box[0], ((box[3] - box[1]) * frame.width) / frame.height);
  const scale = (0.88 * frame.width) / across;
  const middle = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
  const round = (x) => Math.round(x * 100) / 100;
  return {
    frame,
    at: ([u, v]) => [
      round(frame.x + frame.width / 2 + scale * (u - middle[0])),
      round(frame.y + frame.height / 2 - scale * (v - middle[1])),
    ],
    window: {
      left: middle[0] - frame.width / 2 / scale,
      top: middle[1] + frame.height / 2 / scale,
      right: middle[0] + frame.width / 2 / scale,
      bottom: middle[1] - frame.height / 2 / scale,
    },
  };
}

/* Ticks at steps of 1, 2 or 5 times a power of ten, about five across. */
function ticks(low, high, step) {
  const first = Math.ceil(low / step);
  const last = Math.floor(high / step);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => (first + k) * step);
}

function niceStep(across) {
  const power = 10 ** Math.floor(Math.log10(across / 5));
  const times = across / 5 / power;
  return power * (times > 5 ? 10 : times > 2 ? 5 : times > 1 ? 2 : 1);
}

function axes({ frame, at, window: { left, top, right, bottom: lowest } }, plane) {
  const step = niceStep(right - left);
  const bottom = frame.y + frame.height;
  const text = (x, y, anchor, words) => svg('text', { x, y, 'text-anchor': anchor }, words);
  const along = ticks(left, right, step).map((u) => {
    const [x] = at([u, lowest]);
    return [
      svg('path', { class: 'ray-grid', d: `M${x} ${frame.y}V${bottom}` }),
      text(x, bottom + 13, 'middle', digits(u)),
    ];
  });
  const up = ticks(lowest, top, step).map((v) => {
    const [, y] = at([left, v]);
    return [
      svg('path', { class: 'ray-grid', d: `M${frame.x} ${y}h${frame.width}` }),
      text(frame.x - 5, y + 3.5, 'end', digits(v)),
    ];
  });
  return svg(
    'g',
    { class: 'ray-axes' },
    along,
    up,
    svg('rect', { class: 'ray-frame', ...frame }),
    text(frame.x + frame.width / 2, HEIGHT - 5, 'middle', say('{axis}, scene units', { axis: plane.uName })),
    text(4, frame.y + 4, 'start', plane.vName),
  );
}
