/* The toolbar over the image, and its pointer and key events: those of the active tool, and scrolling and zooming the
 * image, panning the camera, pinching, and the pixel readout, which all tools share.
 * exports: createToolbar(view, lab, readout) -> {node, bar, options, tool, use, chosen} */

import { dragging, takeBack } from '../shared/escape.js';
import { button, element, gesture, icon, unique, write } from '../shared/ui.js';
import { moveCamera, panCamera, unitsPerPixel } from './camera_moves.js';

const ZOOM = 1.25;
const PAN = 48;

const hex = (byte) => byte.toString(16).padStart(2, '0');

export function createToolbar(view, lab, readout) {
  const tools = new Map();
  const radios = element('div', { class: 'segments tools', role: 'radiogroup', 'aria-label': 'Pointer tool' });
  const options = element('div', { class: 'tool-options' });
  const level = element('button', {
    type: 'button',
    class: 'button quiet small level',
    title: 'Actual pixels (1)',
    onclick: () => view.actual(),
  });
  const bar = element('div', { class: 'bar-end' });
  const node = element(
    'div',
    { class: 'toolbar' },
    radios,
    options,
    element(
      'div',
      { class: 'bar-end' },
      button('Zoom out', () => view.zoom(1 / ZOOM), {
        icon: 'zoomout',
        bare: true,
        kind: 'quiet',
        small: true,
        title: 'Zoom out (-)',
      }),
      level,
      button('Zoom in', () => view.zoom(ZOOM), {
        icon: 'zoomin',
        bare: true,
        kind: 'quiet',
        small: true,
        title: 'Zoom in (+)',
      }),
      button('Fit', () => view.fit(), {
        icon: 'fit',
        bare: true,
        kind: 'quiet',
        small: true,
        title: 'Fit the image (0)',
      }),
      bar,
    ),
  );
  const group = unique('tool');
  let chosen = null;
  let drag = null;
  let space = false;

  listen(view.stage);
  lab.on('view', () => {
    write(level, { textContent: `${Math.round(view.scale * devicePixelRatio * 100)} %` });
  });
  return { node, bar, options, tool, use, chosen: () => chosen };

  function tool(name, what) {
    tools.set(name, what);
    if (what.label) {
      const input = element('input', { type: 'radio', name: group, value: name, class: 'visually-hidden' });
      input.addEventListener('change', () => use(name));
      what.radio = input;
      what.segment = element(
        'label',
        { class: 'segment', title: what.hint },
        input,
        icon(what.icon || 'move'),
        element('span', { text: what.label }),
      );
    }
    radios.replaceChildren(
      ...[...tools.values()]
        .filter((each) => each.segment)
        .sort((a, b) => (a.order ?? 50) - (b.order ?? 50))
        .map((each) => each.segment),
    );
    if (chosen && tools.get(chosen).radio) tools.get(chosen).radio.checked = true;
  }

  function use(name) {
    if (!tools.has(name) || name === chosen) return;
    const before = tools.get(chosen);
    chosen = name;
    before?.dropped?.();
    const now = tools.get(name);
    if (now.radio) now.radio.checked = true;
    view.stage.style.cursor = now.cursor || 'default';
    now.chosen?.();
    lab.emit('tool', name);
  }

  function listen(stage) {
    createPinch(stage, lab, letGo);
    stage.addEventListener('pointerdown', down);
    stage.addEventListener('pointermove', move);
    stage.addEventListener('pointerup', up);
    stage.addEventListener('pointercancel', up);
    stage.addEventListener('pointerleave', () => {
      readout.hidden = true;
      tools.get(chosen)?.leave?.();
    });
    stage.addEventListener('wheel', wheel, { passive: false });
    stage.addEventListener('keydown', key);
    stage.addEventListener('keyup', (event) => {
      if (event.key === ' ') space = false;
    });
    stage.addEventListener('blur', () => {
      space = false;
    });
    stage.addEventListener('contextmenu', (event) => {
      if (drag) event.preventDefault();
    });
  }

  /* Each has back(), for Escape. */
  function panTheCamera(name) {
    return Object.assign((dx, dy) => panCamera(lab, dx, dy, name), { back: () => takeBack(name) });
  }

  function panTheImage() {
    const { left, top, fitted } = view.place;
    const back = () => {
      Object.assign(view.place, { left, top, fitted });
      view.redraw();
    };
    return Object.assign((dx, dy) => view.pan(dx, dy), { back });
  }

  function cancel() {
    const { pans } = drag;
    drag = null;
    if (pans) pans.back();
    else tools.get(chosen)?.cancel?.();
  }

  function down(event) {
    if (event.target.closest('button, input, select, a') || drag) return;
    view.stage.focus({ preventScroll: true });
    const point = view.fromEvent(event);
    const pans = event.button === 1 ? panTheCamera(gesture('pan')) : event.button === 0 && space ? panTheImage() : null;
    if (!pans && event.button !== 0) return;
    if (!pans && tools.get(chosen)?.down?.(point, event) === false) return;
    drag = { id: event.pointerId, start: point, pans, x: event.clientX, y: event.clientY, end: dragging(cancel) };
    view.stage.setPointerCapture(event.pointerId);
    event.preventDefault();
  }

  function move(event) {
    const point = view.fromEvent(event);
    read(point);
    if (!drag) {
      tools.get(chosen)?.hover?.(point, event);
    } else if (event.pointerId === drag.id) {
      if (drag.pans) {
        drag.pans(event.clientX - drag.x, event.clientY - drag.y);
        Object.assign(drag, { x: event.clientX, y: event.clientY });
      } else {
        tools.get(chosen)?.move?.(point, event, drag.start);
      }
    }
  }

  function up(event) {
    if (drag && event.pointerId === drag.id) letGo(event);
  }

  function letGo(event) {
    if (!drag) return;
    const { pans, end } = drag;
    drag = null;
    end();
    if (!pans) tools.get(chosen)?.up?.(view.fromEvent(event), event);
  }

  function wheel(event) {
    const lines = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
    if (event.ctrlKey || event.metaKey) {
      const box = view.stage.getBoundingClientRect();
      view.zoom(Math.exp(-lines / 400), { x: event.clientX - box.left, y: event.clientY - box.top });
    } else if (tools.get(chosen)?.wheel) {
      tools.get(chosen).wheel(view.fromEvent(event), event, lines);
    } else {
      view.pan(-event.deltaX, -lines);
    }
    event.preventDefault();
  }

  function key(event) {
    if (event.target !== view.stage || event.altKey) return;
    const arrows = { ArrowLeft: [PAN, 0], ArrowRight: [-PAN, 0], ArrowUp: [0, PAN], ArrowDown: [0, -PAN] };
    const zooms = {
      '+': () => view.zoom(ZOOM),
      '=': () => view.zoom(ZOOM),
      '-': () => view.zoom(1 / ZOOM),
      0: () => view.fit(),
      1: () => view.actual(),
    };
    if (event.ctrlKey && arrows[event.key]) view.pan(...arrows[event.key]);
    else if (event.ctrlKey || event.metaKey) return;
    else if (event.key === ' ') space = true;
    else if (zooms[event.key]) zooms[event.key]();
    else if (!tools.get(chosen)?.key?.(event) && !view.camera?.key(event)) return;
    event.preventDefault();
  }

  /* Shows position and bytes of a pixel; not in a drag: the image moves, and reading it costs as much as drawing. */
  function read(point) {
    const bytes = point.inside && !drag ? view.pixel(point.x, point.y) : null;
    write(readout, { hidden: !bytes });
    if (!bytes) return;
    const [r, g, b] = bytes;
    readout.replaceChildren(
      element('span', { class: 'swatch', style: { background: `rgb(${r} ${g} ${b})` } }),
      element('span', { text: `x ${Math.floor(point.x)}  y ${Math.floor(point.y)}` }),
      element('span', { text: `${r} ${g} ${b}` }),
      element('span', { text: `#${hex(r)}${hex(g)}${hex(b)}` }),
    );
  }
}

/* --- two fingers on the image, with every tool ---
 * Their distance scales the camera's distance from the pivot, and their centre pans. letGo(event) ends the drag of the
 * active tool that the first finger began. */

const LEAST_PX = 20; /* fingers that touch each other have no useful ratio of distances */

function createPinch(stage, lab, letGo) {
  const touches = new Map();
  /* From the second finger down until both are lifted: the start of the gesture, and the moves already sent. A pointer
   * event moves only one finger, and the server's camera lags behind. So each event computes the pan of the complete
   * gesture, at the distance that its zoom leads to, and sends the difference from what was sent before; the sum of
   * single pans at the distances in between would shift the image. */
  let pinch = null; /* {x, y, spread, distance; sent: {spread, right, up}; gesture} */

  const listen = (name, act) =>
    stage.addEventListener(
      name,
      (event) => {
        if (event.pointerType === 'touch' && act(event)) event.stopPropagation();
      },
      { capture: true },
    );
  listen('pointerdown', down);
  listen('pointermove', move);
  for (const name of ['pointerup', 'pointercancel']) listen(name, lift);

  /* Returns true for events that the tools must not see; so do move and lift. */
  function down(event) {
    touches.set(event.pointerId, { x: event.clientX, y: event.clientY });
    if (touches.size < 2) return false;
    if (touches.size === 2) {
      letGo(event);
      begin();
      stage.setPointerCapture(event.pointerId);
    }
    return true;
  }

  function begin() {
    const first = span();
    const sent = { spread: first.spread, right: 0, up: 0 };
    const name = gesture('pinch');
    const end = dragging(() => {
      pinch = null;
      takeBack(name);
    });
    pinch = { ...first, distance: lab.state?.view?.distance, sent, gesture: name, end };
  }

  function span() {
    const [a, b] = [...touches.values()];
    return {
      x: (a.x + b.x) / 2,
      y: (a.y + b.y) / 2,
      spread: Math.max(LEAST_PX, Math.hypot(a.x - b.x, a.y - b.y)),
    };
  }

  function move(event) {
    const touch = touches.get(event.pointerId);
    if (!touch || !pinch) return false;
    Object.assign(touch, { x: event.clientX, y: event.clientY });
    if (touches.size === 2 && pinch.distance && lab.view.width) send(span());
    return true;
  }

  function send(now) {
    const { sent } = pinch;
    const unit = unitsPerPixel(lab, (pinch.distance * pinch.spread) / now.spread);
    const right = -(now.x - pinch.x) * unit;
    const up = (now.y - pinch.y) * unit;
    moveCamera(lab, { zoom: sent.spread / now.spread, step: [right - sent.right, up - sent.up, 0] }, pinch.gesture);
    pinch.sent = { spread: now.spread, right, up };
  }

  /* The remaining finger does not continue with the tool. */
  function lift(event) {
    const mine = Boolean(pinch);
    touches.delete(event.pointerId);
    if (touches.size === 0) {
      pinch?.end();
      pinch = null;
    }
    return mine;
  }
}
