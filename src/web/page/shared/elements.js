/* Elements, ids, memory and icons, for ui.js and its parts (see there).
 * What elements show is translated (language.js): text, children that are strings, title, label and the like. Data is
 * not: names of objects, paths, words of the scene file are in an element with translate: 'no', or in code, pre, samp.
 * exports: element, svg, replace, write, unique, gesture, gestures, memory, icon */

import { translated } from './language.js';

const SVG = 'http://www.w3.org/2000/svg';
const SHOWN = new Set(['text', 'title', 'label', 'alt', 'placeholder', 'aria-label', 'aria-valuetext']);
const WRITTEN = new Set(['textContent', 'title', 'placeholder', 'alt', 'ariaLabel']);
const DATA = '[translate=no], code, pre, samp';
let counter = 0;

function assign(node, name, given, data) {
  if (given === null || given === undefined || given === false) return;
  const value = !data && SHOWN.has(name) ? translated(given) : given;
  if (name === 'text') node.textContent = value;
  else if (name === 'dataset') Object.assign(node.dataset, value);
  else if (name === 'style') for (const [key, what] of Object.entries(value)) node.style.setProperty(key, what);
  else if (name === 'on') for (const [event, listener] of Object.entries(value)) node.addEventListener(event, listener);
  else if (name === 'value') node.value = value;
  else if (typeof value === 'function' && name.startsWith('on')) node.addEventListener(name.slice(2), value);
  else node.setAttribute(name, value === true ? '' : value);
}

const parts = (children, data) =>
  children
    .flat(Infinity)
    .filter((child) => child !== null && child !== undefined && child !== false)
    .map((child) => (data ? child : translated(child)));

function fill(node, properties, children) {
  const data = properties?.translate === 'no' || node.matches(DATA);
  for (const [name, value] of Object.entries(properties || {})) if (name !== 'value') assign(node, name, value, data);
  node.append(...parts(children, data));
  if (properties && properties.value !== undefined) assign(node, 'value', properties.value);
  return node;
}

export const element = (tag, properties, ...children) => fill(document.createElement(tag), properties, children);
export const svg = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

export function replace(node, ...children) {
  node.replaceChildren(...parts(children, Boolean(node.closest?.(DATA))));
  return node;
}

/* Assigns only what differs: an equal value would also cause a layout. */
export function write(node, properties) {
  for (const [name, given] of Object.entries(properties)) {
    const value = WRITTEN.has(name) && !node.closest?.(DATA) ? translated(given) : given;
    if (node[name] !== value) node[name] = value;
  }
}

export const unique = (prefix = 'id') => `${prefix}-${++counter}`;
export const gesture = (prefix = 'drag') =>
  `${prefix}-${Date.now().toString(36)}-${++counter}-${Math.random().toString(36).slice(2, 8)}`.slice(-64);

/* Presses of one kind that follow each other without a pause are one gesture; held: in a drag, which may pause. */
export function gestures(prefix, pauseMs = 800) {
  let last = null;
  return {
    at(timeStamp, what = '', held = false) {
      const continues = last && last.what === what && (held || timeStamp - last.at <= pauseMs);
      last = { what, name: continues ? last.name : gesture(prefix), at: timeStamp };
      return last.name;
    },
    end() {
      last = null;
    },
  };
}

/* Storage may be disabled or cleared at any time: it is only a convenience. */
export const memory = {
  get(key, otherwise) {
    try {
      const kept = localStorage.getItem(`cuvette.${key}`);
      return kept === null ? otherwise : JSON.parse(kept);
    } catch {
      return otherwise;
    }
  },
  set(key, value) {
    try {
      localStorage.setItem(`cuvette.${key}`, JSON.stringify(value));
    } catch {
      /* the value is not remembered then */
    }
  },
};

/* Line icons in the colour of the surrounding text; they are decoration: a button is named by its text. */
const paths = {
  undo: 'M4 9h10a6 6 0 0 1 0 12h-3M8 5 4 9l4 4',
  redo: 'M20 9H10a6 6 0 0 0 0 12h3M16 5l4 4-4 4',
  reset: 'M4 5v5h5M4.6 10A8 8 0 1 1 4 14',
  refresh: 'M20 11a8 8 0 0 0-14.5-4L4 9M4 4v5h5M4 13a8 8 0 0 0 14.5 4l1.5-2M20 20v-5h-5',
  image: 'M4 5h16v14H4zM4 16l5-5 4 4 2-2 5 5M15.5 9.5h.01',
  video: 'M4 4h16v16H4zM8 4v16M16 4v16M4 9h4M4 15h4M16 9h4M16 15h4',
  copy: 'M9 9h11v11H9zM5 15H4V4h11v1',
  duplicate: 'M9 9h11v11H9zM5 15H4V4h11v1M14.5 12v5M12 14.5h5',
  terminal: 'M3 5h18v14H3zM7 10l3 2.5L7 15M12 15h5',
  drop: 'M12 3c4 5 6 8 6 11a6 6 0 0 1-12 0c0-3 2-6 6-11',
  cloud: 'M7 18a4 4 0 0 1 0-8 5 5 0 0 1 9.6-1A4.5 4.5 0 1 1 17 18z',
  sun:
    'M12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8M12 2v2M12 20v2M2 12h2M20 12h2M5 5l1.4 1.4M17.6 17.6 19 19' +
    'M5 19l1.4-1.4M17.6 6.4 19 5',
  moon: 'M20 14.5A8.5 8.5 0 0 1 9.5 4 8.5 8.5 0 1 0 20 14.5',
  help: 'M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18M9.5 9.5a2.5 2.5 0 1 1 3.6 2.2c-.8.4-1.1 1-1.1 1.8M12 17h.01',
  close: 'M6 6l12 12M18 6 6 18',
  check: 'M4 13l5 5L20 6',
  info: 'M12 3a9 9 0 1 0 0 18 9 9 0 0 0 0-18M12 11v6M12 7.5h.01',
  warning: 'M12 4 2.5 20h19zM12 10v5M12 17.5h.01',
  orbit: 'M12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6M21 9c1 3-2 6-7 7.5s-10 1-11-1.5 1-6 6-7.8M18 5l3 4-4.5 1.5',
  beam: 'M2 12h7M9 5v14M9 12l12-7M9 12h12M9 12l12 7',
  light: 'M9 18h6M10 21h4M12 3a6 6 0 0 0-3.5 10.9c.7.6 1 1.3 1 2.1h5c0-.8.3-1.5 1-2.1A6 6 0 0 0 12 3',
  section: 'M3 5h18v14H3zM12 5c3 4 3 10 0 14M12 5c-3 4-3 10 0 14M3 12h6M15 12l6-3',
  camera: 'M3 7h11v10H3zM14 11l7-4v10l-7-4',
  search: 'M10.5 4a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13M15.5 15.5 21 21',
  plus: 'M12 5v14M5 12h14',
  zoomin: 'M10.5 4a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13M15.5 15.5 21 21M7.5 10.5h6M10.5 7.5v6',
  zoomout: 'M10.5 4a6.5 6.5 0 1 0 0 13 6.5 6.5 0 0 0 0-13M15.5 15.5 21 21M7.5 10.5h6',
  fit: 'M4 9V4h5M20 9V4h-5M4 15v5h5M20 15v5h-5',
  left: 'M19 12H5M11 6l-6 6 6 6',
  right: 'M5 12h14M13 6l6 6-6 6',
  up: 'M12 19V5M6 11l6-6 6 6',
  down: 'M12 5v14M6 13l6 6 6-6',
  earlier: 'M15 5l-7 7 7 7',
  later: 'M9 5l7 7-7 7',
  forward: 'M12 20V9M8 12l4-4 4 4M5 4h14',
  back: 'M12 4v11M8 12l4 4 4-4M5 20h14',
  turnleft: 'M4 12a8 8 0 1 1 3 6.2M4 5v7h7',
  turnright: 'M20 12a8 8 0 1 0-3 6.2M20 5v7h-7',
  tiltup: 'M5 18c0-8 6-11 12-11M13 3l4 4-4 4',
  tiltdown: 'M5 6c0 8 6 11 12 11M13 13l4 4-4 4',
  pixel: 'M12 2v6M12 16v6M2 12h6M16 12h6M10 10h4v4h-4z',
  hand:
    'M7 12V6.5a1.5 1.5 0 0 1 3 0V11M10 10V4.5a1.5 1.5 0 0 1 3 0V11M13 10V6a1.5 1.5 0 0 1 3 0v6' +
    'M16 10a1.5 1.5 0 0 1 3 0v4c0 4-2.5 7-6 7-4 0-5.5-2-7.5-5.5L4 13c.8-1.2 2-1 3 .5',
  move: 'M12 2v20M2 12h20M9 5l3-3 3 3M9 19l3 3 3-3M5 9l-3 3 3 3M19 9l3 3-3 3',
  play: 'M7 4l13 8-13 8z',
  pause: 'M7 4h3v16H7zM14 4h3v16h-3z',
  stop: 'M5 5h14v14H5z',
  trash: 'M4 7h16M9 7V4h6v3M6 7l1 14h10l1-14M10 11v6M14 11v6',
  folder: 'M3 6h6l2 2h10v11H3z',
  save: 'M5 4h11l4 4v12H4V4zM8 4v5h7V4M8 20v-6h8v6',
  download: 'M12 3v12M7 10l5 5 5-5M4 20h16',
  bookmark: 'M6 3h12v18l-6-5-6 5z',
  pin: 'M9 4h6l-1 6 3 3H7l3-3zM12 13v7',
  eye: 'M2 12s4-7 10-7 10 7 10 7-4 7-10 7S2 12 2 12M12 9a3 3 0 1 0 0 6 3 3 0 0 0 0-6',
  ruler: 'M2 16 16 2l6 6L8 22zM6 12l2 2M9 9l3 3M12 6l2 2',
  enlarge: 'M14 4h6v6M20 4l-7 7M10 20H4v-6M4 20l7-7',
  estimate: 'M12 4a8 8 0 1 0 0 16 8 8 0 0 0 0-16M12 8v4l3 2',
  trace: 'M2 4l10 8M2 20l10-8M2 12h20M12 12l9-6M12 12l9 6',
  chart: 'M4 4v16h16M8 16l4-6 3 3 5-7',
  cube: 'M12 3l8 4.5v9L12 21l-8-4.5v-9zM4 7.5l8 4.5 8-4.5M12 12v9',
  book: 'M12 6C10 4.5 7 4 3 4v14c4 0 7 .5 9 2 2-1.5 5-2 9-2V4c-4 0-7 .5-9 2zM12 6v14',
  blocks: 'M3 13h8v8H3zM13 13h8v8h-8zM8 3h8v8H8z',
  prism: 'M12 4l8 16H4zM1 15l6-1.5M16.5 12l6-1.5M17.5 14.5l5 .5',
  halves: 'M4 5h16v14H4zM12 2v20M12 13l6-6M12 18l8-8',
  flask: 'M9 3h6M10 3v6L4.2 18.8A1.5 1.5 0 0 0 5.5 21h13a1.5 1.5 0 0 0 1.3-2.2L14 9V3M7 15h10',
  cuvette: 'M6 3v15a3 3 0 0 0 3 3h6a3 3 0 0 0 3-3V3M6 10h12M15.5 2 11 18',
  screen: 'M3 4h18v12H3zM12 16v4M8 20h8',
};

export function icon(name) {
  return svg(
    'svg',
    { class: 'icon', viewBox: '0 0 24 24', 'aria-hidden': 'true', focusable: 'false' },
    svg('path', { d: paths[name] || paths.info }),
  );
}
