/* The bench in two dimensions: the scene cut by a plane, in place of the image. The outlines are those of `cuvette
 * section`, the rays those of the scene's beams.
 *
 * exports: createSection(lab); sets lab.section:
 *   open(view?, {at, window}?), close(), toggle()     view: 'top', 'front', 'side', 'axis' (of the selected solid);
 *                                        without it the plane in which the beams run; at: the plane's coordinate;
 *                                        window: [u0, u1, v0, v1] to show
 *   present(show or null)                opens what a lesson shows, as its `show` (cuvette-lesson(5)); null: ends it
 *   tools                                protractor, ruler and screen (section_tools.js)
 *   shown                                whether it is open
 *   addBeam()                            adds a laser in the plane
 *   place(), size()                      where a new thing goes, and its size: section_place.js
 *   set(name, on)                        the switches 'angles', 'images', 'grid', 'snap'
 *   fit()                                shows all
 *   copy()                               the drawing as an SVG element with all its style
 *   node                                 the drawing, an SVG element
 *   plane, port, areas, segments, hits   what is drawn, as in section_plane.js and section_rays.js; null before the
 *                                        first reply
 *   images                               where the rays of beams meet: section_images.js
 *   drawn                                the generation of the outlines and rays that are shown
 *   draw(), ask()                        draws again; requests what is missing */

import { say, translated } from '../shared/language.js';
import {
  button,
  checkbox,
  choice as choiceOf,
  digits,
  element,
  memory,
  number,
  replace,
  svg,
  vector,
  write,
} from '../shared/ui.js';
import { dot } from '../shared/vectors.js';
import { segmentsOf } from './rays.js';
import { sectionExports } from './section_export.js';
import { createFormula } from './section_formula.js';
import { createHand } from './section_hand.js';
import { imageMarks, imagesOf } from './section_images.js';
import { gridMarks, gridSteps, legendMarks, legendRoom, lightMarks, mediumFill, scaleMarks } from './section_marks.js';
import { glassPlane, placeOf, sizeOf } from './section_place.js';
import { axisName, createPort, flat } from './section_plane.js';
import { extensionMarks, hitMarks, hitName, hitsOf, rayMarks } from './section_rays.js';
import { createTools } from './section_tools.js';

const VIEWS = [
  ['top', 'Top'],
  ['front', 'Front'],
  ['side', 'Side'],
  ['axis', 'Axis'],
];
const AXIS_OF = { top: 1, front: 2, side: 0 };
const MARGIN = 0.3; /* beyond the window, for pans */
const CELLS = { moving: 96, resting: 420 };
const REST_MS = 180;
const RETRY_MS = 2000; /* after an error */
const ZOOM = 1.25;
const HITS_MAX = 150; /* that have a mark */
const ANGLES_MAX = 40; /* hits with angles at once */
const STRONG = 0.05; /* fraction of a ray below which a hit has no angles by itself */

export function createSection(lab) {
  const port = createPort();
  const layers = Object.fromEntries(
    ['grid', 'solids', 'rays', 'beyond', 'lights', 'labels', 'images', 'hits', 'angles', 'hand'].map((name) => [
      name,
      svg('g', { class: `section-${name}` }),
    ]),
  );
  const drawing = svg(
    'svg',
    {
      class: 'section-drawing',
      id: 'section',
      tabindex: '0',
      role: 'application',
      'aria-label':
        'Section of the scene. Tab goes from object to object; arrow keys move the selected object, R turns it, ' +
        'otherwise they scroll; plus and minus magnify, 0 shows all, A shows angles, I images, 2 returns to the image',
    },
    Object.values(layers),
  );
  const notice = element('p', { class: 'section-notice', role: 'status', hidden: true });
  const stage = element('div', { class: 'section-stage' }, drawing, notice);
  const options = {
    angles: memory.get('section.angles', false),
    grid: memory.get('section.grid', true),
    snap: memory.get('section.snap', false),
    images: memory.get('section.images', true),
  };
  const section = {
    node: drawing,
    layers,
    port,
    options,
    shown: false,
    view: 'front',
    at: null /* of the plane on its normal; null: through the beams */,
    plane: null,
    extent: null,
    unitM: 1,
    areas: [],
    segments: [],
    hits: [],
    images: [],
    pinned: new Set(),
    drawn: 0,
    marks: null /* {normals, angles, extensions}: of a lesson */,
    window: null /* what "Show all" shows, in scene units; null: all */,
    open,
    present,
    close,
    toggle: () => (section.shown ? close() : open()),
    set,
    fit,
    addBeam,
    place: () => placeOf(lab, section),
    size: () => sizeOf(lab, section),
    draw: later,
    ask,
  };
  lab.section = section;
  const bar = createBar(lab, section, { look, moveTo });
  const hand = createHand(lab, section, stage);
  const formula = createFormula(lab, section, stage);
  const tools = createTools(lab, section);
  const root = element('section', { class: 'section', 'aria-label': 'Section', hidden: true }, bar.node, stage);
  const host = lab.view.stage.parentElement;
  host.append(root);
  const opener = button('2D bench', () => section.toggle(), {
    icon: 'section',
    kind: 'quiet',
    small: true,
    title: 'The bench in two dimensions: a section through the scene, with rays and angles (2)',
  });
  lab.view.bar.prepend(opener);

  new ResizeObserver(resize).observe(stage);
  lab.on('state', ask);
  lab.on('scene', later);
  lab.on('restarted', () => {
    section.drawn = 0;
    section.extent = null;
  });
  lab.choice?.on(() => {
    if (section.view === 'axis') look('axis');
    later();
  });

  /* --- open, close, plane --- */

  /* The view in whose plane the rays of each beam stay best; without beams, through glass. */
  async function usualPlane() {
    section.segments = await raysOf().catch(() => []);
    if (!section.segments.length) return glassPlane(lab) || { view: 'front' };
    const spread = [0, 0, 0];
    for (const beam of new Set(section.segments.map((each) => each.beam))) {
      const mine = section.segments.filter((each) => each.beam === beam && each.one.weight >= STRONG);
      const points = mine.flatMap(({ line, one }) => (one.node.hit ? [line.from, one.node.hit.point] : [line.from]));
      for (const axis of [0, 1, 2]) {
        const values = points.map((point) => point[axis]);
        spread[axis] += values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
      }
    }
    const least = Math.min(...spread) + 1e-6;
    return { view: ['front', 'top', 'side'].find((view) => spread[AXIS_OF[view]] <= least) };
  }

  async function open(view, { at = null, window = null } = {}) {
    const usual = view || section.plane ? { view: view || section.view, at } : await usualPlane();
    const first = usual.view;
    if (!section.shown) {
      section.shown = true;
      section.view = first;
      lab.panels?.reveal();
      root.hidden = false;
      host.classList.add('in-section');
      write(opener, { ariaExpanded: 'true' });
      lab.emit('section', true);
      resize();
    }
    look(first, usual.at, window);
    drawing.focus({ preventScroll: true });
  }

  function close() {
    if (!section.shown) return;
    section.shown = false;
    root.hidden = true;
    host.classList.remove('in-section');
    write(opener, { ariaExpanded: 'false' });
    lab.emit('section', false);
    lab.view.stage.focus({ preventScroll: true });
  }

  async function present(show) {
    section.marks = show;
    options.images = show ? false : memory.get('section.images', true); /* a pupil finds them */
    bar.show();
    if (!show || show.view === 'image') {
      section.window = null;
      if (!show) tools.put();
      close();
      return;
    }
    section.plane = null;
    section.pinned.clear();
    await open(show.view, { at: show.at, window: show.window });
  }

  function look(view, at = null, window = null) {
    section.window = window;
    if (view === 'axis' && lab.object(lab.choice?.name)?.kind !== 'solid') {
      lab.say('Select a solid: the plane then contains its axis.');
      bar.show();
      return;
    }
    section.at = view === 'axis' ? null : (at ?? throughChosen(AXIS_OF[view]));
    section.view = view;
    bar.show();
    fit();
  }

  /* The plane's coordinate on a world axis: through the middle of the selected object. */
  function throughChosen(axis) {
    const { name, object, group } = lab.choice || {};
    const place = name && lab.param(`${name}.position`)?.value;
    if (!place || lab.scene.shapes.find((each) => each.shape === object?.shape)?.unbounded) return null;
    return Number((place[axis] + (group.centre?.[axis] ?? 0)).toPrecision(12));
  }

  function moveTo(at) {
    section.at = at;
    section.extent = null;
    turned++;
    ask();
  }

  function set(name, on) {
    options[name] = on;
    memory.set(`section.${name}`, on);
    bar.show();
    later();
  }

  function fit() {
    section.extent = null;
    section.fitted = Boolean(section.window);
    if (section.window) port.fit(section.window, legendRoom(port, []));
    turned++;
    ask();
  }

  /* A laser from the left of the window through its middle. */
  async function addBeam() {
    const { origin, right, up } = section.plane || {};
    if (!origin) return;
    const [u0, u1] = port.extent();
    const at = (u) => origin.map((x, axis) => Number((x + u * right[axis] + port.v * up[axis]).toPrecision(5)));
    const values = { position: at(u0 + 0.08 * (u1 - u0)), target: at(port.u) };
    await lab.choice.add({ kind: 'beam', set: values });
  }

  function resize() {
    if (!section.shown || !stage.clientWidth) return;
    const first = !port.width;
    Object.assign(port, { width: stage.clientWidth, height: stage.clientHeight });
    drawing.setAttribute('viewBox', `0 0 ${port.width} ${port.height}`);
    if (first || !section.fitted) fit();
    else ask();
    later();
  }

  /* --- requests: one at a time; the newest reply is shown --- */

  let asking = false;
  let again = false;
  let resting = 0;
  let asked = '';
  let turned = 0; /* changes of the plane: replies for an earlier one are void */

  function address(cells) {
    const plane = new URLSearchParams();
    if (section.view === 'axis') plane.set('through', lab.choice.name);
    else {
      plane.set('view', section.view);
      if (section.at !== null)
        plane.set(
          'at',
          [0, 1, 2].map((axis) => (axis === AXIS_OF[section.view] ? section.at : 0)),
        );
    }
    if (section.fitted) plane.set('extent', port.extent(MARGIN));
    return `/api/section?${plane}&cells=${cells}`;
  }

  /* Whether the window is inside what was asked, and not much smaller. */
  function covers() {
    const [have, need] = [section.extent, port.extent()];
    if (!have) return false;
    const inside = have[0] <= need[0] && have[1] >= need[1] && have[2] <= need[2] && have[3] >= need[3];
    return inside && have[1] - have[0] < 4 * (need[1] - need[0]);
  }

  async function ask() {
    if (!section.shown || !port.width || !lab.scene) return;
    if (asking) {
      again = true;
      return;
    }
    const generation = lab.newestGeneration;
    const moving = section.drawn !== 0 && (lab.dragging() || hand.busy());
    const cells = moving ? CELLS.moving : CELLS.resting;
    const path = address(cells);
    clearTimeout(resting);
    if (moving) resting = setTimeout(ask, REST_MS);
    if (generation === section.drawn && covers() && section.cells >= cells) return;
    if (`${generation} ${path}` === asked) return;
    asked = `${generation} ${path}`;
    asking = true;
    await request(path, generation, cells);
    asking = false;
    if (again) {
      again = false;
      requestAnimationFrame(ask);
    }
  }

  async function request(path, generation, cells) {
    const traced = generation === section.drawn;
    const mine = turned;
    try {
      const [reply, beams] = await Promise.all([lab.get(path), traced ? null : raysOf()]);
      if (mine !== turned) {
        asked = '';
        again = true;
        return;
      }
      const { origin, right, up, normal, extent, areas, unit_m: unitM } = reply;
      Object.assign(section, { plane: { origin, right, up, normal }, areas, unitM, extent, cells, drawn: generation });
      if (beams) section.segments = beams;
      note('');
      if (!section.fitted) {
        port.fit(extent, legendRoom(port, areas));
        section.fitted = true;
        again = true; /* the window has another shape than the extent */
      }
    } catch (error) {
      if (error.status) note([error.message, error.remedy].filter(Boolean).join(' – '));
      asked = '';
      resting = setTimeout(ask, RETRY_MS);
    }
    bar.show();
    later();
  }

  /* Also of a scene without beams: the page's copy of the scene may be older than the reply. */
  async function raysOf() {
    return (await lab.get('/api/beams')).beams.flatMap(segmentsOf);
  }

  function note(text) {
    write(notice, { textContent: text, hidden: !text });
  }

  /* --- drawing, at most once a frame --- */

  let frame = 0;

  function later() {
    if (section.shown) frame ||= requestAnimationFrame(draw);
  }

  function draw() {
    frame = 0;
    const { plane, areas, segments } = section;
    if (!plane || !port.width) return;
    section.steps = gridSteps(port);
    const grid = options.grid ? gridMarks(port, plane, section.steps) : { lines: [], labels: [] };
    replace(layers.grid, grid.lines);
    drawSolids();
    replace(layers.rays, rayMarks(port, plane, segments));
    replace(layers.beyond, section.marks?.extensions ? extensionMarks(port, plane, segments) : []);
    const legend = legendMarks(port, areas);
    replace(layers.labels, grid.labels, scaleMarks(port, section.unitM), legend);
    section.room = legend.slice(0, 1).map((plate) => {
      const [x, y, width, height] = ['x', 'y', 'width', 'height'].map((name) => Number(plate.getAttribute(name)));
      return [x, y, x + width, y + height];
    });
    section.images = options.images ? imagesOf(lab, plane, segments) : [];
    replace(layers.lights, lightMarks(lab, port, plane));
    replace(layers.images, imageMarks(port, section.images, section.room));
    formula.show(section.images);
    section.hits = hitsOf(port, plane, segments).slice(0, HITS_MAX);
    drawHits();
    hand.draw();
    tools.draw();
  }

  const solids = new Map();

  /* The elements stay, so that the focus stays. */
  function drawSolids() {
    const names = new Set(section.areas.map(({ solid }) => solid));
    for (const [name, node] of solids)
      if (!names.has(name)) {
        node.remove();
        solids.delete(name);
      }
    for (const area of section.areas) {
      if (!solids.has(area.solid)) {
        const made = svg('path', { class: 'section-solid', tabindex: '0', role: 'button', 'fill-rule': 'evenodd' });
        made.dataset.name = area.solid;
        solids.set(area.solid, made);
        layers.solids.append(made);
      }
      const node = solids.get(area.solid);
      const ring = (points) =>
        `M${points.map(([u, v]) => `${port.x(u).toFixed(2)} ${port.y(v).toFixed(2)}`).join('L')}Z`;
      node.setAttribute('d', area.rings.map(ring).join(''));
      node.style.setProperty('fill', mediumFill(area));
      const chosen = lab.choice?.name === area.solid;
      node.classList.toggle('chosen', chosen);
      node.setAttribute('aria-pressed', String(chosen));
      node.setAttribute('aria-label', solidName(area));
    }
  }

  function solidName({ solid, medium, opaque, n }) {
    const place = lab.param(`${solid}.position`)?.value;
    const at = place ? say(', at {place}', { place: vector(flat(section.plane, place).slice(0, 2), 4) }) : '';
    return `${solid}, ${opaque ? say('opaque') : `${medium}, n = ${digits(n, 5)}`}${at}`;
  }

  /* The strongest hits have their angles if they are switched on; those that were clicked or have the focus, always. */
  function drawHits() {
    const { hits, pinned, plane } = section;
    const focused = layers.hits.contains(document.activeElement) ? document.activeElement.dataset.key : null;
    const nodes = hits.map((mark) => {
      const node = svg(
        'g',
        { class: 'section-hit', tabindex: '0', role: 'button', 'aria-pressed': String(pinned.has(mark.key)) },
        svg('circle', { class: 'grip', cx: mark.x, cy: mark.y, r: 9 }),
        svg('circle', { class: `dot${mark.aside ? ' aside' : ''}`, cx: mark.x, cy: mark.y, r: 2.6 }),
      );
      node.setAttribute('aria-label', hitName(mark));
      node.dataset.key = mark.key;
      return node;
    });
    layers.hits.replaceChildren(...nodes);
    if (focused) nodes.find((node) => node.dataset.key === focused)?.focus({ preventScroll: true });
    const full = hits.filter(({ key }) => pinned.has(key) || key === section.pointed);
    const { marks } = section;
    const some =
      options.angles || marks?.angles || marks?.normals
        ? hits.filter((mark) => !full.includes(mark) && mark.weight >= STRONG && !mark.aside).slice(0, ANGLES_MAX)
        : [];
    const room = [...section.room];
    layers.angles.replaceChildren(
      ...full.flatMap((mark) => hitMarks(port, plane, mark, { full: true, room })),
      ...some.flatMap((mark) =>
        hitMarks(port, plane, mark, { full: false, room, bare: !options.angles && !marks?.angles }),
      ),
    );
  }
}

/* --- the bar: plane, switches, window, exports --- */

function createBar(lab, section, { look, moveTo }) {
  const views = choiceOf({ label: 'Plane', choices: VIEWS, radios: true, value: 'front', onchange: (to) => look(to) });
  const place = number({ label: 'at', value: 0, onchange: moveTo });
  const switches = [
    ['angles', 'Angles', 'Normal, angles of incidence and refraction at each hit (A); a click on a hit shows its own'],
    [
      'images',
      'Images',
      'Where rays meet or seem to come from, with their dashed extensions, and the lens formula (I)',
    ],
    ['grid', 'Grid', 'A grid in scene units (G)'],
    ['snap', 'Snap', 'Move to the grid and turn by 5° (N); Shift does the opposite while dragging'],
  ].map(([name, label, title]) => {
    const part = checkbox(label, section.options[name], (on) => section.set(name, on));
    part.node.title = translated(title);
    return { name, ...part };
  });
  const zoom = (factor) => {
    section.port.zoom(factor);
    section.ask();
    section.draw();
  };
  const { saveSvg, print, copy } = sectionExports(lab, section);
  section.copy = copy;
  const small = { bare: true, kind: 'quiet', small: true };
  const node = element(
    'div',
    { class: 'toolbar section-bar', role: 'group', 'aria-label': 'Section' },
    button('Image', () => section.close(), { icon: 'image', small: true, title: 'Back to the image (2)' }),
    views.group || views.node,
    place.node,
    button('Beam', () => section.addBeam(), {
      icon: 'plus',
      small: true,
      title: 'Add a laser in this plane, from the left to the right',
    }),
    element(
      'div',
      { class: 'section-switches' },
      switches.map((each) => each.node),
    ),
    element(
      'div',
      { class: 'bar-end' },
      button('Zoom out', () => zoom(1 / ZOOM), { ...small, icon: 'zoomout', title: 'Zoom out (-)' }),
      button('Zoom in', () => zoom(ZOOM), { ...small, icon: 'zoomin', title: 'Zoom in (+)' }),
      button('Show all', () => section.fit(), { ...small, icon: 'fit', title: 'Show all (0)' }),
      button('SVG', saveSvg, { kind: 'quiet', small: true, title: 'Save this drawing as an SVG file' }),
      button('PDF', print, {
        kind: 'quiet',
        small: true,
        title: 'Print this drawing, or save it as a PDF file, with the dialog of the browser',
      }),
    ),
  );
  return { node, show };

  function show() {
    views.set(section.view);
    for (const each of switches) each.set(section.options[each.name]);
    const axis = AXIS_OF[section.view];
    place.node.hidden = axis === undefined;
    if (axis === undefined || !section.plane) return;
    const { origin, normal } = section.plane;
    const name = axisName(normal)?.slice(-1);
    if (!name) return;
    const label = place.node.querySelector('label');
    if (label) write(label, { textContent: `${name} =` });
    place.set(Number((dot(origin, normal) * (axisName(normal).startsWith('-') ? -1 : 1)).toPrecision(6)));
  }
}
