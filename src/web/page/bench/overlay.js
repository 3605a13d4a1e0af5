/* Draws the bench over the image: beams, the chosen segment with its normal, measured points, the screen, the fan.
 *
 * exports: createBenchOverlay(lab, bench) -> {draw(), nearest(point) -> {segment, at} or null}
 *   bench: {rays, chosen, points, screen, fan} of panel_bench.js; at: the point in the scene, a hit or start if one is
 *   near */

import { labelSize } from '../shared/display.js';
import { digits, svg } from '../shared/ui.js';
import { add, length, minus, times } from '../shared/vectors.js';
import { fanMarks } from './fan.js';
import { degrees } from './measure.js';
import { distance, fraction } from './ray_overlay.js';
import { edged, inked, isCut, lineBetween, pointAt, seenLine } from './ray_tree.js';

const LINES_MAX = 3000;
const WIDEST = 2.6; /* CSS pixels, of a ray with all its power */
const NEAR_PX = 9;
const POINT_PX = 11; /* a hit or a start within this distance is preferred to a point between them */

const LETTER = 0.58; /* mean width of a letter, in heights of the text */

const meet = (a, b) => a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3];
const at = ([x1, y1], [x2, y2]) => ({ x1, y1, x2, y2 });

export function createBenchOverlay(lab, bench) {
  const layer = lab.view.layer('bench');
  let pieces = [];
  let room = []; /* boxes of the labels that are drawn */
  return { draw, nearest };

  function draw() {
    room = [];
    const shown = bench.rays.segments.filter(({ one }) => !isCut(one)).slice(0, LINES_MAX);
    pieces = shown.map(piece).filter(Boolean);
    const { chosen, points } = bench;
    layer.replaceChildren(
      ...pieces.map((each) => line(each, 'bench-halo')),
      svg('g', { class: 'bench-rays' }, ...pieces.map((each) => line(each, nameOf(each.segment)))),
      ...(bench.fan ? fanMarks(bench.fan, { stroke, dot }) : []),
      ...(bench.screen ? outline(bench.screen) : []),
      ...(chosen ? atHit(chosen) : []),
      ...measured(points),
    );
  }

  function nameOf(segment) {
    return segment === bench.chosen ? 'bench-ray chosen' : 'bench-ray';
  }

  /* The part of a line on the canvas. */
  function seen(line) {
    const { view, state } = lab;
    return state?.camera && view.width ? seenLine(line, state.camera, view, view.frame()) : null;
  }

  function piece(segment) {
    const ends = seen(segment.line);
    return ends && { segment, a: ends[0], b: ends[1] };
  }

  function line({ segment, a, b }, name) {
    const { weight } = segment.one;
    return name === 'bench-halo'
      ? edged(svg('line', { class: name, ...at(a, b) }), weight, WIDEST, 2)
      : inked(svg('line', { class: name, ...at(a, b), stroke: segment.css }), weight, WIDEST);
  }

  function stroke(line, name) {
    const ends = seen(line);
    return ends ? [svg('line', { class: name, ...at(ends[0], ends[1]) })] : [];
  }

  function dot(point, name) {
    const place = lab.view.project(point);
    return place ? [svg('circle', { class: name, cx: place.x, cy: place.y, r: 4 / lab.view.scale })] : [];
  }

  function label(point, text) {
    const place = lab.view.project(point);
    if (!place) return [];
    const size = labelSize() / lab.view.scale;
    const width = LETTER * size * text.length;
    const spots = [1, 2, 3].flatMap((far) => [
      [place.x + 0.7 * size, place.y - (1.3 * far - 0.7) * size],
      [place.x + 0.7 * size, place.y + 1.3 * far * size],
      [place.x - 0.7 * size - width, place.y - (1.3 * far - 0.7) * size],
      [place.x - 0.7 * size - width, place.y + 1.3 * far * size],
    ]);
    const boxes = spots.map(([x, y]) => [x, y - size, x + width, y + 0.3 * size]);
    const free = boxes.findIndex((box) => !room.some((other) => meet(box, other)));
    const [x, y] = spots[Math.max(0, free)];
    room.push(boxes[Math.max(0, free)]);
    return [svg('text', { class: 'bench-text', x, y, 'font-size': size }, text)];
  }

  /* The normal to both sides of the surface, and the angles. */
  function atHit({ one }) {
    const { hit } = one.node;
    if (!hit) return [];
    const arm = times(hit.normal, Math.max(0.25 * hit.t, 0.06 * (lab.state.camera?.distance || 1)));
    const second = hit.opaque ? 'opaque' : hit.tir ? 'total reflection' : degrees(hit.snell.refraction_deg, 5);
    return [
      ...stroke(lineBetween(minus(hit.point, arm), add(hit.point, arm)), 'bench-normal'),
      ...dot(hit.point, 'bench-hit'),
      ...label(hit.point, `${degrees(hit.snell.incidence_deg, 5)} → ${second}`),
    ];
  }

  function measured(points) {
    return points.flatMap((point, i) => [
      ...(i ? stroke(lineBetween(points[i - 1], point), 'bench-measure') : []),
      ...dot(point, 'bench-point'),
      ...label(point, i ? digits(length(minus(point, points[i - 1])), 5) : '0'),
    ]);
  }

  function outline({ corners }) {
    return corners.flatMap((corner, i) =>
      stroke(lineBetween(corner, corners[(i + 1) % corners.length]), 'bench-screen'),
    );
  }

  function nearest(point) {
    let best = null;
    let least = NEAR_PX / lab.view.scale;
    for (const piece of pieces) {
      const away = distance([point.x, point.y], piece.a, piece.b);
      if (away < least) [best, least] = [piece, away];
    }
    return best && { segment: best.segment, at: snapped(best, point) };
  }

  /* An end of the segment, or the point on its drawn part whose image is nearest. */
  function snapped({ segment: { line, one, tree }, a, b }, point) {
    const away = (place) => {
      const seen = lab.view.project(place);
      return seen ? Math.hypot(seen.x - point.x, seen.y - point.y) : Infinity;
    };
    const ends = one.node.hit ? [line.from, one.node.hit.point] : [line.from];
    const end = ends.find((each) => away(each) * lab.view.scale < POINT_PX);
    if (end) return end;
    const [first, last] = [a[2], b[2]];
    /* Of a parallel view, the image has the proportions of the line, which may lead behind the camera. */
    if (lab.state.camera.parallel && Number.isFinite(last))
      return pointAt(line, first + (last - first) * fraction([point.x, point.y], a, b));
    const along = (t) =>
      pointAt(line, Number.isFinite(last) ? first + (last - first) * t : first + (tree.reach * t) / (1 - t));
    let [low, high] = [0, 1];
    for (let i = 0; i < 60; i++) {
      const [a, b] = [low + (high - low) / 3, high - (high - low) / 3];
      if (away(along(a)) <= away(along(b))) high = b;
      else low = a;
    }
    return along((low + high) / 2);
  }
}
