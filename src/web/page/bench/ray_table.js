/* The rays of a pixel as a table with expandable rows.
 *
 * exports: createRayTable({caption, onmark(ray or null)}) -> {node, show(tree or null), mark(ray or null),
 * reveal(ray), openAll(), closeAll()}
 * Rows are created when they become visible, since a tree may be very large. Arrow keys work as in any tree grid. */

import { element } from '../shared/ui.js';
import { columns, describe, lineClass } from './ray_tree.js';

const OPEN_AT_FIRST = 30;
const OPEN_AT_MOST = 2000;

/* The key columns wrap, so that all of them are visible next to the image. */
const cellClass = (ray, key) =>
  [
    ['media', 'angles', 'reflectance'].includes(key) && 'ray-key',
    ray.node.hit?.tir && key === 'reflectance' && 'ray-total',
  ]
    .filter(Boolean)
    .join(' ') || null;

export function createRayTable({ caption, onmark }) {
  const head = element(
    'tr',
    {},
    columns.map(([, label, title]) => element('th', { scope: 'col', text: label, title })),
  );
  const body = element('tbody', {});
  const node = element(
    'div',
    { class: 'table-frame ray-table' },
    element(
      'table',
      { role: 'treegrid', 'aria-label': caption },
      element('caption', { class: 'visually-hidden', text: caption }),
      element('thead', {}, head),
      body,
    ),
  );
  let rows = new Map(); /* the visible rows, by ray */
  let open = new Set();
  let tree = null;
  let marked = null;

  body.addEventListener('keydown', (event) => {
    if (!event.altKey && !event.ctrlKey && !event.metaKey && press(event.key)) event.preventDefault();
  });
  body.addEventListener('focusin', (event) => note(rayOf(event.target)));
  body.addEventListener('pointermove', (event) =>
    note(rayOf(event.target)),
  ); /* not pointerover, which a row also gets when it scrolls under the resting pointer */
  body.addEventListener('pointerleave', () => note(null));
  body.addEventListener('click', (event) => {
    const ray = rayOf(event.target);
    if (!ray) return;
    focus(ray);
    if (event.target.closest('.ray-twist')) toggle(ray);
  });

  return {
    node,
    mark,
    show(next) {
      tree = next;
      marked = null;
      open = new Set();
      if (tree) openUpTo(OPEN_AT_FIRST);
      draw();
    },
    reveal(ray) {
      for (let above = ray.parent; above; above = above.parent) open.add(above);
      if (!rows.has(ray)) draw();
      focus(ray);
      rows.get(ray).scrollIntoView({ block: 'nearest' });
    },
    openAll() {
      openUpTo(OPEN_AT_MOST);
      draw();
    },
    closeAll() {
      open = new Set();
      draw();
    },
  };

  function note(ray) {
    mark(ray);
    onmark(ray);
  }

  function rayOf(target) {
    const row = target.closest('tr');
    return row && tree ? tree.rays[Number(row.dataset.ray)] : null;
  }

  /* Opens level by level while the row limit permits. */
  function openUpTo(most) {
    let shown = tree.roots.length;
    let level = tree.roots;
    while (level.length && shown < most) {
      const next = [];
      for (const ray of level) {
        if (!ray.children.length || shown + ray.children.length > most) continue;
        open.add(ray);
        shown += ray.children.length;
        next.push(...ray.children);
      }
      level = next;
    }
  }

  function visible() {
    const list = [];
    const walk = (siblings) =>
      siblings.forEach((ray, place) => {
        list.push([ray, place + 1, siblings.length]);
        if (open.has(ray)) walk(ray.children);
      });
    if (tree) walk(tree.roots);
    return list;
  }

  function draw() {
    const before = rows;
    const focused = rayOf(document.activeElement?.closest?.('tbody') === body ? document.activeElement : body);
    rows = new Map();
    for (const [ray, place, among] of visible()) rows.set(ray, before.get(ray) || row(ray, place, among));
    for (const [ray, tr] of rows) if (ray.children.length) tr.setAttribute('aria-expanded', String(open.has(ray)));
    body.replaceChildren(...rows.values());
    if (focused && rows.has(focused)) rows.get(focused).focus({ preventScroll: true });
    else if (rows.size && ![...rows.values()].some((tr) => tr.tabIndex === 0)) rows.values().next().value.tabIndex = 0;
  }

  function row(ray, place, among) {
    const words = describe(ray);
    const cells = columns.slice(1).map(([key]) => element('td', { class: cellClass(ray, key), text: words[key] }));
    const first = element(
      'th',
      { scope: 'row' },
      element(
        'span',
        { class: 'ray-name', style: { '--ray-level': String(ray.level - 1) } },
        element('span', { class: ray.children.length ? 'ray-twist' : 'ray-leaf', 'aria-hidden': 'true' }),
        element('span', { class: `ray-mark ${lineClass(ray)}`, 'aria-hidden': 'true' }),
        words.kind,
      ),
    );
    return element(
      'tr',
      {
        role: 'row',
        tabindex: '-1',
        'aria-level': ray.level,
        'aria-posinset': place,
        'aria-setsize': among,
        dataset: { ray: String(ray.index) },
      },
      first,
      cells,
    );
  }

  function mark(ray) {
    let shown = ray;
    while (shown && !rows.has(shown)) shown = shown.parent;
    if (shown === marked) return;
    if (marked) rows.get(marked)?.classList.remove('marked');
    marked = shown;
    if (marked) rows.get(marked).classList.add('marked');
  }

  function focus(ray) {
    for (const tr of rows.values()) tr.tabIndex = -1;
    const tr = rows.get(ray);
    tr.tabIndex = 0;
    tr.focus({ preventScroll: true });
    tr.scrollIntoView({ block: 'nearest', inline: 'nearest' });
  }

  function toggle(ray) {
    if (!ray.children.length) return;
    if (!open.delete(ray)) open.add(ray);
    draw();
    focus(ray);
  }

  function press(key) {
    const ray = rayOf(document.activeElement);
    if (!ray) return false;
    const list = [...rows.keys()];
    const at = list.indexOf(ray);
    const step = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: list.length - 1 }[key];
    if (step !== undefined) {
      if (list[step]) focus(list[step]);
      return true;
    }
    if (key === 'ArrowRight' && ray.children.length) {
      if (open.has(ray)) focus(ray.children[0]);
      else toggle(ray);
      return true;
    }
    if (key === 'ArrowLeft') {
      if (open.has(ray)) toggle(ray);
      else if (ray.parent) focus(ray.parent);
      return true;
    }
    if (key === 'Enter') toggle(ray);
    return key === 'Enter';
  }
}
