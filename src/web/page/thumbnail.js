/* A thumbnail of a scene or lesson, fetched when it comes into sight; a blank one if it cannot be rendered.
 * exports: thumbnail(lab, path) -> img element */

import { element } from './ui.js';

/* path -> promise of an address of the page's own */
const fetched = new Map();

/* One at a time, in the order of sight: the server renders one at a time too. */
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
