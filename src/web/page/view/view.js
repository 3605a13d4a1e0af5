/* The image view: draws the image, maps scene points to pixels, and runs the pointer tools.
 *
 * exports: createView(root, lab) -> view
 *   view.width, view.height             of the full image in pixels; 0 before the first
 *   view.project([x,y,z])               to {x, y, depth} in image pixels (x from the left edge, y from the top, not
 *                                       rounded); null behind the camera
 *   view.toScreen(x, y)                 image pixels to {x, y} in CSS pixels from the upper left corner of the stage
 *   view.fromEvent(event)               {x, y, inside} in image pixels, not rounded: the pixel is Math.floor of each
 *   view.scale                          CSS pixels per image pixel
 *   view.frame()                        {left, top, right, bottom}: the canvas in image pixels; drawings over the image
 *                                       end at its edge
 *   view.layer(name)                    an SVG group over the image in image pixels (0,0 is the upper left corner of
 *                                       the first pixel), created on first use; strokes keep their screen width
 *                                       (vector-effect). Use svg() of ui.js for its children
 *   view.overlay                        an HTML element over the stage, for buttons placed by toScreen; only its
 *                                       children receive pointer events
 *   view.tool(name, tool)               {label, icon, hint, order, cursor, down(point, event), move(point, event,
 *                                       start), up(point, event), cancel(), hover(point, event), leave(),
 *                                       wheel(point, event), key(event) -> true when handled,
 *                                       chosen(), dropped()}; all optional. A tool with a label appears in the
 *                                       toolbar. If down returns false, no drag starts.
 *                                       point is the result of fromEvent. cancel() takes a drag back, instead of up
 *   view.use(name)                      activates a tool; view.chosen is its name
 *   view.options                        an element of the toolbar for controls of the active tool (empty it in dropped)
 *   view.stage                          the element that receives pointer and key events
 *   view.pixel(x, y)                    [r, g, b] bytes of the displayed image; null outside or before the first image
 *   view.zoom(factor, at), view.fit(), view.actual()     at: {x, y} on the stage
 *   view.show(blob or null)             displays another image of the full size instead of the pass, for comparisons;
 *                                       null restores the pass. Promise
 *   view.redraw()
 *   view.note(name, text or null, onclose)   a line at the upper edge that names what is drawn over the image, with a
 *                                       button that removes it; a later note of that name replaces it
 *   view.behind(is)                     is() -> whether a drawing over the image still belongs to an older scene
 *   view.isDrawn()                      whether none does
 * lab.on('view', f) reports a change of scale, position or size: elements in overlay must be placed again. */

import { say } from '../shared/language.js';
import { button, element, svg, write } from '../shared/ui.js';
import { spreadAt } from '../shared/vectors.js';
import { createAxes } from './axes.js';
import { createPainting } from './painting.js';
import { createToolbar } from './tools.js';

export function createView(root, lab) {
  const canvas = element('canvas', { class: 'view-canvas', 'aria-hidden': 'true' });
  const layers = svg('g');
  const drawing = svg('svg', { class: 'view-layers', 'aria-hidden': 'true' }, layers);
  const overlay = element('div', { class: 'view-overlay' });
  const readout = element('div', { class: 'readout', hidden: true });
  const waiting = element('div', { class: 'view-waiting', hidden: true });
  const notes = createNotes();
  notes.node.append(waiting);
  const stage = element(
    'div',
    {
      class: 'stage',
      id: 'image',
      tabindex: '0',
      role: 'application',
      'aria-label':
        'Image. Arrow keys orbit, Page Up and Page Down move nearer and farther, W A S D Q E step, X Y Z look from ' +
        'the sides, plus and minus magnify; question mark lists all keys',
    },
    canvas,
    drawing,
    overlay,
    createAxes(lab),
    readout,
    notes.node,
  );
  const named = new Map();
  const late = [];

  const view = {
    stage,
    overlay,
    width: 0,
    height: 0,
    get scale() {
      return place.scale;
    },
    project,
    frame,
    toScreen: (x, y) => place.toScreen(x, y),
    fromEvent,
    layer,
    pixel: (x, y) => painting.pixel(x, y),
    zoom: (factor, at) => place.zoom(factor, at),
    fit: () => place.fit(),
    actual: () => place.actual(),
    pan: (dx, dy) => place.pan(dx, dy),
    show: (blob) => painting.show(blob),
    note: notes.note,
    redraw,
    behind: (is) => late.push(is),
    isDrawn: () => !late.some((is) => is()),
  };
  const place = createPlace(stage, view, redraw);
  const painting = createPainting(canvas, view, place, lab);
  const toolbar = createToolbar(view, lab, readout);
  Object.assign(view, { tool: toolbar.tool, use: toolbar.use, options: toolbar.options, bar: toolbar.bar, place });
  Object.defineProperty(view, 'chosen', { get: () => toolbar.chosen() });

  root.append(toolbar.node, stage);
  keepFirstImage(root, stage, lab);
  const explain = () => {
    const { state } = lab;
    if (!state) return;
    const why = state.trouble
      ? [state.trouble.error, state.trouble.remedy].filter(Boolean).join(' – ')
      : state.waiting || (lab.image ? '' : 'Loading the scene …');
    write(waiting, { textContent: why || '', hidden: !why });
    waiting.classList.toggle('trouble', Boolean(state.trouble));
  };
  lab.on('state', explain);
  lab.on('image', explain);
  return view;

  function redraw() {
    layers.setAttribute('transform', `translate(${place.left} ${place.top}) scale(${place.scale})`);
    painting.paint();
    lab.emit('view', view);
  }

  function project(point) {
    const camera = lab.state?.camera;
    if (!camera || !view.width) return null;
    const d = point.map((value, axis) => value - camera.eye[axis]);
    const along = (axis) => d[0] * axis[0] + d[1] * axis[1] + d[2] * axis[2];
    const depth = along(camera.forward);
    if (!(depth > 1e-9)) return null;
    const spread = spreadAt(camera, depth);
    return {
      x: ((along(camera.right) / (spread * camera.half_width) + 1) * view.width) / 2,
      y: ((1 - along(camera.up) / (spread * camera.half_height)) * view.height) / 2,
      depth,
    };
  }

  function frame() {
    const [upper, lower] = [place.fromScreen(0, 0), place.fromScreen(place.width, place.height)];
    return { left: upper.x, top: upper.y, right: lower.x, bottom: lower.y };
  }

  function fromEvent(event) {
    const box = stage.getBoundingClientRect();
    const at = place.fromScreen(event.clientX - box.left - stage.clientLeft, event.clientY - box.top - stage.clientTop);
    return { ...at, inside: at.x >= 0 && at.y >= 0 && at.x < view.width && at.y < view.height };
  }

  function layer(name) {
    if (!named.has(name)) {
      const group = svg('g', { class: `layer layer-${name}` });
      named.set(name, group);
      layers.append(group);
    }
    return named.get(name);
  }
}

/* A site has an image in its page (src/web/site/bundle.py), which is shown until the engine has rendered one. */
function keepFirstImage(root, stage, lab) {
  const early = root.querySelectorAll('.first-image, .first-progress');
  stage.prepend(...early);
  const [image] = early;
  const room = (name) => image[`client${name}`] / image[`natural${name}`];
  const scale = image ? Math.min(room('Width'), room('Height')) : 1;
  if (scale > 1 && scale < CRISP) image.style.objectFit = 'none'; /* where the engine's image will be */
  const end = lab.on('image', () => {
    if (!lab.image) return;
    for (const node of early) node.remove();
    end();
  });
}

/* --- the placement of the image on the stage: fitted, or zoomed about a point --- */

const MARGIN = 12;
const LARGEST = 64;
const SMALLEST = 0.05;
const CRISP = 1.2; /* an image that would be enlarged by less is shown at actual pixels */

const aligned = (x) => Math.round(x * devicePixelRatio) / devicePixelRatio;

function createPlace(stage, view, changed) {
  const place = {
    scale: 1,
    left: 0,
    top: 0,
    fitted: true,
    width: 0,
    height: 0,
    toScreen: (x, y) => ({ x: place.left + x * place.scale, y: place.top + y * place.scale }),
    fromScreen: (x, y) => ({ x: (x - place.left) / place.scale, y: (y - place.top) / place.scale }),
    zoom,
    fit,
    actual,
    pan,
    size,
  };
  new ResizeObserver(() => size()).observe(stage);
  return place;

  function size() {
    const { clientWidth, clientHeight } = stage;
    if (!clientWidth || !clientHeight) return;
    const dx = (clientWidth - place.width) / 2;
    const dy = (clientHeight - place.height) / 2;
    place.width = clientWidth;
    place.height = clientHeight;
    if (place.fitted) fit();
    else {
      place.left += dx;
      place.top += dy;
      keepInSight();
    }
  }

  function fit() {
    place.fitted = true;
    if (view.width && place.width) {
      place.scale = Math.max(
        SMALLEST / 4,
        Math.min((place.width - 2 * MARGIN) / view.width, (place.height - 2 * MARGIN) / view.height),
      );
      const enlarged = place.scale * devicePixelRatio;
      if (enlarged > 1 && enlarged < CRISP) place.scale = 1 / devicePixelRatio;
      place.left = aligned((place.width - view.width * place.scale) / 2);
      place.top = aligned((place.height - view.height * place.scale) / 2);
    }
    changed();
  }

  function zoom(factor, at = { x: place.width / 2, y: place.height / 2 }) {
    const { x, y } = place.fromScreen(at.x, at.y);
    place.fitted = false;
    place.scale = Math.min(LARGEST, Math.max(SMALLEST, place.scale * factor));
    place.left = at.x - x * place.scale;
    place.top = at.y - y * place.scale;
    keepInSight();
  }

  function actual() {
    zoom(1 / (place.scale * devicePixelRatio));
    place.left = aligned(place.left);
    place.top = aligned(place.top);
    changed();
  }

  function pan(dx, dy) {
    place.fitted = false;
    place.left += dx;
    place.top += dy;
    keepInSight();
  }

  /* Keeps the image over at least a quarter of the stage. */
  function keepInSight() {
    const keep = (start, length, room) => Math.min(room * 0.75, Math.max(room * 0.25 - length, start));
    place.left = keep(place.left, view.width * place.scale, place.width);
    place.top = keep(place.top, view.height * place.scale, place.height);
    changed();
  }
}

/* --- notes at the upper edge --- */

function createNotes() {
  const node = element('div', { class: 'view-notes' });
  const notes = new Map();
  return { node, note };

  function note(name, text, onclose) {
    const old = notes.get(name);
    if (text !== null && old?.text === text) return;
    old?.node.remove();
    notes.delete(name);
    if (text === null) return;
    const line = element(
      'div',
      { class: 'view-note' },
      element('span', { text }),
      button(say('Close: {text}', { text }), onclose, { icon: 'close', bare: true, small: true, kind: 'quiet' }),
    );
    notes.set(name, { text, node: line });
    node.append(line);
  }
}
