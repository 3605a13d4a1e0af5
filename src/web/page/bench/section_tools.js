/* The tools of the section: a protractor, a ruler and a screen, which are dragged, or moved by keys. Their readings
 * are those of a hand: the tools know nothing of rays, but a point that is let go next to a hit goes to it.
 *
 * exports: createTools(lab, section); sets section.tools:
 *   take({tool, place, to, from, arms, reads})   shows a tool, as a lesson's `hand` (cuvette-lesson(5))
 *   put()                                        takes it away
 *   tool                                         {kind, points, arms, ..} in world space, or null
 *   power                                        percent of the beams' power that a screen receives; null: not known
 *   reading                                      degrees, scene units, or percent of the power; null: none yet
 *   on(f)                                        f() is called when the reading changes; returns its end
 *   draw() */

import { digits, element, svg, write } from '../shared/ui.js';
import { say } from '../shared/language.js';
import { add, dot, length, minus, unit } from '../shared/vectors.js';
import { flat, placed } from './section_plane.js';

const DIAL_PX = 118;
const ARM_PX = 150;
const SNAP_PX = 9;
const SCREEN_PX = 40; /* from the middle of the screen to its ends, at first */
const STRONG = 0.05;
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const RADIANS = Math.PI / 180;

const round = (x) => Number(x.toFixed(2));
const middle = ([a, b]) => a.map((x, axis) => (x + b[axis]) / 2);
const toward = ([x, y], angle, size) => [x + size * Math.cos(angle * RADIANS), y - size * Math.sin(angle * RADIANS)];
const between = (a, b) => Math.abs(((((a - b) % 360) + 540) % 360) - 180);

export function createTools(lab, section) {
  const { port, node: drawing } = section;
  const layer = svg('g', { class: 'section-tools' });
  const spoken = element('p', { class: 'visually-hidden', 'aria-live': 'polite' });
  const listeners = new Set();
  let parts = null;
  let drag = null;
  let asked = 0;
  let waiting = 0;

  drawing.append(layer);
  drawing.parentElement.append(spoken);
  layer.addEventListener('pointerdown', down);
  layer.addEventListener('pointermove', move);
  for (const name of ['pointerup', 'pointercancel']) layer.addEventListener(name, up);
  layer.addEventListener('keydown', key);

  const tools = {
    tool: null,
    reading: null,
    power: null,
    take,
    put,
    draw,
    on(listener) {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
  };
  section.tools = tools;
  lab.on('scene', () => tools.tool?.kind === 'screen' && tools.tool.placed && expose());
  return tools;

  function take({ tool: kind, place, to, from, arms, reads }) {
    const points = kind === 'ruler' ? [place, to] : [place];
    tools.power = null;
    tools.tool = { kind, points, arms: arms && [...arms], from, reads, placed: kind !== 'screen' };
    tools.reading = null;
    build();
    draw();
  }

  function put() {
    tools.tool = null;
    tools.reading = null;
    parts = null;
    layer.replaceChildren();
  }

  /* --- readings --- */

  function changed() {
    const { kind, points, arms, from, reads } = tools.tool;
    if (kind === 'protractor') read(between(arms[0], arms[1]));
    else if (kind === 'ruler') read(length(minus(points[1], points[0])));
    else {
      if (reads === 'distance') read(length(minus(middle(points), from)));
      expose();
    }
    draw();
  }

  function read(value) {
    tools.reading = value;
    for (const listener of listeners) listener();
  }

  /* The screen is as high as it is wide; one request at a time. */
  async function expose() {
    const mine = ++asked;
    clearTimeout(waiting);
    if (!tools.tool) return;
    if (!section.plane) return;
    if (drag) {
      waiting = setTimeout(expose, 60);
      return;
    }
    const { points, reads } = tools.tool;
    const across = minus(points[1], points[0]);
    const { normal } = section.plane;
    const facing = [
      across[1] * normal[2] - across[2] * normal[1],
      across[2] * normal[0] - across[0] * normal[2],
      across[0] * normal[1] - across[1] * normal[0],
    ];
    const size = Math.max(length(across), 1e-6);
    try {
      const answer = await lab.get(
        `/api/beams/screen?centre=${middle(points)}&normal=${unit(facing)}&size=${size},${size}&bins=1,1&rays=0`,
      );
      if (mine !== asked || !tools.tool) return;
      tools.power = (100 * answer.received) / answer.power;
      if (reads === 'power') read(tools.power);
      draw();
    } catch (error) {
      if (mine === asked) lab.fail(error);
    }
  }

  /* --- drawing: the elements of a tool stay, so that the focus stays --- */

  function at(point) {
    const [u, v] = flat(section.plane, point);
    return [port.x(u), port.y(v)];
  }

  function handle(index, label) {
    const node = svg(
      'g',
      { class: 'section-tool-handle', tabindex: '0', role: 'button', 'aria-label': label },
      svg('circle', { class: 'grip', r: 22 }),
      svg('circle', { class: 'knob', r: 7 }),
    );
    node.dataset.handle = index;
    return node;
  }

  function build() {
    const { kind } = tools.tool;
    const names = {
      protractor: [say('Middle of the protractor'), say('First arm'), say('Second arm')],
      ruler: [say('Start of the ruler'), say('End of the ruler')],
      screen: [say('One end of the screen'), say('Other end of the screen')],
    }[kind];
    const body = svg('path', { class: `section-tool-body ${kind}` });
    parts = {
      body,
      grab: kind === 'protractor' ? null : svg('path', { class: 'section-tool-grab', tabindex: '0', role: 'button' }),
      ticks: svg('path', { class: 'section-tool-ticks' }),
      words: svg('g', { class: 'section-tool-words' }),
      spot: svg('path', { class: 'section-tool-spot' }),
      plate: svg('rect', { class: 'section-plate', rx: 4, height: 22 }),
      text: svg('text', { class: 'section-tool-reading', 'text-anchor': 'middle' }),
      handles: names.map((name, index) => handle(index, name)),
    };
    if (parts.grab) {
      parts.grab.dataset.handle = 'all';
      parts.grab.setAttribute('aria-label', kind === 'ruler' ? say('Ruler') : say('Screen'));
    }
    const { ticks, words, spot, plate, text, grab, handles } = parts;
    layer.replaceChildren(...[body, grab, ticks, words, spot, plate, text, ...handles].filter(Boolean));
  }

  function draw() {
    if (!parts || !section.plane || !port.width) return;
    if (!tools.tool.placed && section.drawn >= lab.newestGeneration) raise();
    ({ protractor: drawProtractor, ruler: drawRuler, screen: drawScreen })[tools.tool.kind]();
  }

  /* A screen is at first across the first ray. */
  function raise() {
    const { plane, segments } = section;
    if (!segments.length) return;
    const [place] = tools.tool.points;
    const along = segments[0].line.along;
    const [u, v] = [dot(along, plane.right), dot(along, plane.up)];
    const size = SCREEN_PX / port.scale / Math.hypot(u, v);
    tools.tool.points = [1, -1].map((sign) => add(place, placed(plane, -v * size * sign, u * size * sign)));
    tools.tool.placed = true;
    changed();
  }

  function moveTo(node, [x, y]) {
    node.setAttribute('transform', `translate(${round(x)} ${round(y)})`);
  }

  function label([x, y], words) {
    const { plate, text } = parts;
    const width = 12 + 7.6 * words.length;
    const [px, py] = [
      Math.min(Math.max(x, width / 2 + 4), port.width - width / 2 - 4),
      Math.min(Math.max(y, 16), port.height - 16),
    ];
    for (const [name, value] of Object.entries({ x: px - width / 2, y: py - 11, width }))
      plate.setAttribute(name, value);
    text.setAttribute('x', px);
    text.setAttribute('y', py + 5);
    write(text, { textContent: words });
  }

  function drawProtractor() {
    const { points, arms } = tools.tool;
    const centre = at(points[0]);
    const [a, b] = arms.map((arm) => toward(centre, arm, ARM_PX));
    const tick = (angle) => {
      const [from, to] = [angle % 10 ? (angle % 5 ? 6 : 10) : 14, 0].map((inwards) =>
        toward(centre, arms[0] + angle, DIAL_PX - inwards),
      );
      return `M${from.map(round)}L${to.map(round)}`;
    };
    const circle = (r) =>
      `M${round(centre[0] - r)} ${round(centre[1])}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;
    parts.body.setAttribute('d', circle(DIAL_PX) + circle(DIAL_PX - 34));
    parts.ticks.setAttribute(
      'd',
      [
        ...Array.from({ length: 180 }, (_, k) => tick(2 * k)),
        `M${centre.map(round)}L${a.map(round)}M${centre.map(round)}L${b.map(round)}`,
      ].join(''),
    );
    parts.words.replaceChildren(
      ...Array.from({ length: 12 }, (_, k) => {
        const [x, y] = toward(centre, arms[0] + 30 * k, DIAL_PX - 24);
        return svg(
          'text',
          { x: round(x), y: round(y) + 4, 'text-anchor': 'middle' },
          `${k > 6 ? 360 - 30 * k : 30 * k}`,
        );
      }),
    );
    [centre, a, b].forEach((point, index) => moveTo(parts.handles[index], point));
    const angle = `${digits(between(arms[0], arms[1]), 4)}°`;
    const half = arms[0] + (((((arms[1] - arms[0]) % 360) + 540) % 360) - 180) / 2;
    label(toward(centre, half, 58), angle);
    parts.handles.forEach((each) => each.setAttribute('aria-description', angle));
  }

  function drawRuler() {
    const { points } = tools.tool;
    const [a, b] = points.map(at);
    const size = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
    const [dx, dy] = [(b[0] - a[0]) / size, (b[1] - a[1]) / size];
    const [nx, ny] = dy * 1 - dx * 0 > 0 || (dy === 0 && dx < 0) ? [dy, -dx] : [-dy, dx];
    const corner = ([x, y], s) => `${round(x + s * nx)} ${round(y + s * ny)}`;
    parts.body.setAttribute('d', `M${corner(a, 0)}L${corner(b, 0)}L${corner(b, 26)}L${corner(a, 26)}Z`);
    parts.grab.setAttribute('d', parts.body.getAttribute('d'));
    const step = section.steps.minor;
    const count = Math.min(400, Math.floor(size / port.scale / step + 1e-9));
    const per = Math.max(1, Math.round(section.steps.major / step));
    const point = (k) => [a[0] + dx * k * step * port.scale, a[1] + dy * k * step * port.scale];
    parts.ticks.setAttribute(
      'd',
      Array.from({ length: count + 1 }, (_, k) => `M${corner(point(k), 0)}L${corner(point(k), k % per ? 6 : 12)}`).join(
        '',
      ),
    );
    parts.words.replaceChildren();
    moveTo(parts.handles[0], a);
    moveTo(parts.handles[1], b);
    const words = digits(length(minus(points[1], points[0])), 3);
    label([(a[0] + b[0]) / 2 + 52 * nx, (a[1] + b[1]) / 2 + 44 * ny], words);
    [...parts.handles, parts.grab].forEach((each) => each.setAttribute('aria-description', words));
  }

  function drawScreen() {
    const { points, reads, placed: is } = tools.tool;
    if (!is) return;
    const [a, b] = points.map(at);
    const line = `M${a.map(round)}L${b.map(round)}`;
    parts.body.setAttribute('d', line);
    parts.grab.setAttribute('d', line);
    moveTo(parts.handles[0], a);
    moveTo(parts.handles[1], b);
    const spot = spotOf(points);
    const on = (s) => [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])].map(round);
    parts.spot.setAttribute('d', spot ? `M${on(spot[0])}L${on(spot[1])}` : '');
    const value = tools.reading;
    const wide = spot ? digits((spot[1] - spot[0]) * length(minus(points[1], points[0])), 3) : '';
    const percent = tools.power === null ? '…' : `${digits(tools.power, 3)} %`;
    const words =
      reads === 'power' || value === null
        ? percent
        : spot
          ? say('{distance}, spot {wide}, {percent}', { distance: digits(value, 4), wide, percent })
          : say('{distance}, {percent}', { distance: digits(value, 4), percent });
    label([b[0], Math.max(a[1], b[1]) + 26], words);
    [...parts.handles, parts.grab].forEach((each) => each.setAttribute('aria-description', words));
  }

  /* The part of the screen that rays cross, 0..1 from end to end; null for none. */
  function spotOf([a, b]) {
    const { plane, segments } = section;
    const [a0, b0] = [flat(plane, a), flat(plane, b)];
    const [du, dv] = [b0[0] - a0[0], b0[1] - a0[1]];
    const crossings = segments.flatMap(({ line, one }) => {
      if (one.weight < STRONG) return [];
      const [u, v] = flat(plane, line.from);
      const [pu, pv] = [dot(line.along, plane.right), dot(line.along, plane.up)];
      const det = pu * -dv + pv * du;
      if (Math.abs(det) < 1e-12) return [];
      const [eu, ev] = [a0[0] - u, a0[1] - v];
      const t = (eu * -dv + ev * du) / det;
      const s = (pu * ev - pv * eu) / det;
      return t >= 0 && t <= line.end && s >= 0 && s <= 1 ? [s] : [];
    });
    return crossings.length ? [Math.min(...crossings), Math.max(...crossings)] : null;
  }

  /* --- the pointer and the keys --- */

  function here(event) {
    const box = drawing.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  function down(event) {
    const target = event.target.closest('[data-handle]');
    if (!target || event.button !== 0) return;
    const { points, arms } = tools.tool;
    drag = { id: event.pointerId, which: target.dataset.handle, from: here(event), points, arms: arms && [...arms] };
    target.focus({ preventScroll: true });
    layer.setPointerCapture(event.pointerId);
    event.preventDefault();
    event.stopPropagation();
  }

  function move(event) {
    if (!drag || event.pointerId !== drag.id) return;
    const [x, y] = here(event);
    const by = [(x - drag.from[0]) / port.scale, (drag.from[1] - y) / port.scale];
    const { tool } = tools;
    Object.assign(tool, { points: drag.points, arms: drag.arms && [...drag.arms] });
    if (tool.kind === 'protractor' && drag.which !== '0') {
      const [cx, cy] = at(tool.points[0]);
      tool.arms[Number(drag.which) - 1] = Math.atan2(cy - y, x - cx) / RADIANS;
    } else shift(drag.which, by, true);
    changed();
    event.stopPropagation();
  }

  function up(event) {
    if (!drag || event.pointerId !== drag.id) return;
    drag = null;
    event.stopPropagation();
    changed();
    speak();
  }

  function speak() {
    write(spoken, { textContent: parts?.text.textContent ?? '' });
  }

  /* Moves one point, or all; a screen whose distance is read only along its way. */
  function shift(which, by, snaps) {
    const { tool } = tools;
    let way = placed(section.plane, by[0], by[1]);
    if (tool.kind === 'screen' && tool.reads === 'distance' && which === 'all') {
      const [a, b] = tool.points;
      const across = unit(minus(b, a));
      const off = dot(way, across);
      way = minus(
        way,
        across.map((x) => x * off),
      );
    }
    tool.points = tool.points.map((point, index) => {
      if (which !== 'all' && index !== Number(which)) return point;
      const moved = add(point, way);
      return snaps && which !== 'all' && tool.kind !== 'screen' ? snapped(moved) : moved;
    });
  }

  function snapped(point) {
    const [x, y] = at(point);
    const near = section.hits.find((hit) => Math.hypot(hit.x - x, hit.y - y) < SNAP_PX);
    return near ? near.hit.point : point;
  }

  function key(event) {
    const which = event.target.dataset?.handle;
    const arrow = ARROWS[event.key];
    if (event.key === 'Escape' && drag) {
      Object.assign(tools.tool, { points: drag.points, arms: drag.arms });
      drag = null;
      changed();
    } else if (arrow && which !== undefined && !event.ctrlKey && !event.altKey && !event.metaKey) {
      const { tool } = tools;
      if (tool.kind === 'protractor' && which !== '0')
        tool.arms[Number(which) - 1] += (arrow[1] - arrow[0]) * (event.shiftKey ? 0.1 : 1);
      else {
        const step = section.steps.minor * (event.shiftKey ? 0.1 : 1);
        shift(which, [arrow[0] * step, arrow[1] * step], false);
      }
      changed();
      speak();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
