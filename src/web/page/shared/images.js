/* Images of the API in elements of the page.
 * exports:
 *   showImage(lab, node, path)      in an img or SVG image element; null: no image. The same path again changes
 *                                   nothing; late replies are dropped. The element's data-path is the path
 *   thumbnail(lab, path) -> img     of a scene or lesson, fetched when it comes into sight; blank if it cannot be
 *                                   rendered */

import { element } from './ui.js';

/* If the engine runs in the browser, the bytes of an image are kept until the element shows another image, or is found
 * to be gone. */
const addresses = new Map(); /* node -> address */

function release(engine, node) {
  if (addresses.has(node)) engine.release(addresses.get(node));
  addresses.delete(node);
}

export async function showImage({ engine }, node, path) {
  if ((node.dataset.path ?? null) === path) return;
  const attribute = node instanceof SVGElement ? 'href' : 'src';
  for (const each of [...addresses.keys()]) if (!each.isConnected && each.complete) release(engine, each);
  if (!path) {
    delete node.dataset.path;
    node.removeAttribute(attribute);
    release(engine, node);
    return;
  }
  node.dataset.path = path;
  const address = await engine.address(path).catch(() => null);
  if (node.dataset.path !== path) {
    if (address) engine.release(address);
    return;
  }
  release(engine, node);
  if (!address) {
    delete node.dataset.path; /* it may be fetched again */
    node.removeAttribute(attribute);
    return;
  }
  node.setAttribute(attribute, address);
  addresses.set(node, address);
}

/* path -> promise of an object URL */
const fetched = new Map();

/* One at a time, in the order in which they come into sight: the server renders one at a time too. */
let last = Promise.resolve();

function fetchOne(lab, path) {
  if (!fetched.has(path)) {
    const next = last.then(async () => URL.createObjectURL((await lab.blob(path)).blob));
    fetched.set(path, next);
    last = next.catch(() => fetched.delete(path)); /* tried again the next time */
  }
  return fetched.get(path);
}

const sights = new WeakMap();
const watcher = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries) {
    if (!isIntersecting) continue;
    watcher.unobserve(target);
    sights.get(target)?.();
    sights.delete(target);
  }
});

export function thumbnail(lab, path) {
  const node = element('img', { class: 'thumbnail', alt: '', width: 240, height: 180 });
  sights.set(node, () =>
    fetchOne(lab, path).then(
      (address) => {
        node.src = address;
      },
      () => {},
    ),
  );
  watcher.observe(node);
  return node;
}
