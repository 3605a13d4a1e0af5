/* Elements, ids and memory for ui.js and its parts.
 * exports: element, svg, replace, write, unique, gesture, gestures, memory (see ui.js) */

const SVG = 'http://www.w3.org/2000/svg';
let counter = 0;

function give(node, name, value) {
  if (value === null || value === undefined || value === false) return;
  if (name === 'text') node.textContent = value;
  else if (name === 'dataset') Object.assign(node.dataset, value);
  else if (name === 'style') for (const [key, what] of Object.entries(value)) node.style.setProperty(key, what);
  else if (name === 'on') for (const [event, listener] of Object.entries(value)) node.addEventListener(event, listener);
  else if (name === 'value') node.value = value;
  else if (typeof value === 'function' && name.startsWith('on')) node.addEventListener(name.slice(2), value);
  else node.setAttribute(name, value === true ? '' : value);
}

function fill(node, properties, children) {
  for (const [name, value] of Object.entries(properties || {})) if (name !== 'value') give(node, name, value);
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  if (properties && properties.value !== undefined) give(node, 'value', properties.value);
  return node;
}

export const element = (tag, properties, ...children) => fill(document.createElement(tag), properties, children);
export const svg = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

export function replace(node, ...children) {
  node.replaceChildren(
    ...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false),
  );
  return node;
}

/* Assigns only what differs: an equal value would cost a layout all the same. */
export function write(node, properties) {
  for (const [name, value] of Object.entries(properties)) if (node[name] !== value) node[name] = value;
}

export const unique = (prefix = 'id') => `${prefix}-${++counter}`;
export const gesture = (prefix = 'drag') =>
  `${prefix}-${Date.now().toString(36)}-${++counter}-${Math.random().toString(36).slice(2, 8)}`.slice(-64);

/* Presses of one kind that follow each other without a pause are one gesture; held: a drag goes on, with pauses. */
export function gestures(prefix, pauseMs = 800) {
  let last = null;
  return {
    at(timeStamp, what = '', held = false) {
      const goes = last && last.what === what && (held || timeStamp - last.at <= pauseMs);
      last = { what, name: goes ? last.name : gesture(prefix), at: timeStamp };
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
