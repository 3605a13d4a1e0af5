/* A list of any length: only the items in view are elements. One stop of the tab key; arrow keys, Home, End, Page Up,
 * Page Down and the first letters of a name move the focus.
 *
 * exports: createLongList({label, item, scroller}) -> {node, set(entries), reveal(name), each(f), redraw()}
 *   item(entry) -> a button, for an entry {name, ..}; scroller: the element that scrolls; without it the list's own box
 *   set(entries): other entries; reveal(name): scrolls to it; each(f): f(name, button) of those in view */

import { element } from './ui.js';

const MARGIN = 6; /* items outside the box, so that small scrolls find them */
const LETTERS_MS = 800; /* letters that follow each other within this time are one word */
const ROW_PX = 26; /* until an item has been measured */

export function createLongList({ label, item, scroller }) {
  const list = element('ul', { class: 'long-list', role: 'list', 'aria-label': label });
  const node = scroller ? list : element('div', { class: 'long-box' }, list);
  const box = scroller || node;
  const built = new Map(); /* index: li */
  let entries = [];
  let current = 0; /* the index of the tab stop */
  let row = ROW_PX;
  let letters = { word: '', at: 0 };

  box.addEventListener('scroll', draw, { passive: true });
  new ResizeObserver(draw).observe(box);
  list.addEventListener('keydown', key);
  list.addEventListener('focusin', (event) => point(indexOf(event.target)));
  return { node, set, reveal, each, redraw: draw };

  function set(next) {
    const focused = list.contains(document.activeElement) ? entries[current]?.name : null;
    entries = next;
    for (const li of built.values()) li.remove();
    built.clear();
    const again = focused === null ? -1 : entries.findIndex((entry) => entry.name === focused);
    current = Math.max(0, again);
    draw();
    if (again >= 0) focus(again, { preventScroll: true });
  }

  function each(f) {
    for (const [index, li] of built) f(entries[index].name, li.firstElementChild);
  }

  function indexOf(target) {
    return Number(target.closest('li')?.dataset.index ?? current);
  }

  function point(index) {
    if (built.has(current)) built.get(current).firstElementChild.tabIndex = -1;
    current = index;
    if (built.has(current)) built.get(current).firstElementChild.tabIndex = 0;
  }

  /* The tab stop is always built, so that the focus is not lost when it scrolls out of view. */
  function draw() {
    list.style.height = `${entries.length * row}px`;
    const above = box.getBoundingClientRect().top - list.getBoundingClientRect().top;
    const from = Math.max(0, Math.floor(above / row) - MARGIN);
    const to = Math.min(entries.length - 1, Math.ceil((above + (box.clientHeight || 400)) / row) + MARGIN);
    const wanted = new Set();
    for (let index = from; index <= to; index++) wanted.add(index);
    if (entries.length) wanted.add(current);
    for (const [index, li] of built)
      if (!wanted.has(index)) {
        li.remove();
        built.delete(index);
      }
    for (const index of wanted) if (!built.has(index)) build(index);
    measure();
  }

  function build(index) {
    const one = item(entries[index]);
    one.tabIndex = index === current ? 0 : -1;
    const li = element(
      'li',
      { 'aria-setsize': String(entries.length), 'aria-posinset': String(index + 1), dataset: { index } },
      one,
    );
    li.style.top = `${index * row}px`;
    const after = [...list.children].find((other) => Number(other.dataset.index) > index);
    list.insertBefore(li, after || null);
    built.set(index, li);
  }

  /* Items are higher with enlarged text and for touch. */
  function measure() {
    const [li] = built.values();
    const height = li?.firstElementChild.offsetHeight || row;
    if (height === row) return;
    row = height;
    for (const [index, each] of built) each.style.top = `${index * row}px`;
    draw();
  }

  function focus(index, options = { preventScroll: true }) {
    scrollTo(index);
    point(index);
    draw();
    built.get(index)?.firstElementChild.focus(options);
  }

  function scrollTo(index) {
    const above = box.getBoundingClientRect().top - list.getBoundingClientRect().top;
    const [top, bottom] = [index * row - above, (index + 1) * row - above];
    if (top < 0) box.scrollTop += top;
    else if (bottom > box.clientHeight) box.scrollTop += bottom - box.clientHeight;
  }

  function reveal(name) {
    const index = entries.findIndex((entry) => entry.name === name);
    if (index < 0) return;
    scrollTo(index);
    draw();
  }

  function key(event) {
    if (event.ctrlKey || event.altKey || event.metaKey || !entries.length) return;
    const page = Math.max(1, Math.floor((box.clientHeight || 400) / row) - 1);
    const last = entries.length - 1;
    const to = {
      ArrowDown: current + 1,
      ArrowUp: current - 1,
      PageDown: current + page,
      PageUp: current - page,
      Home: 0,
      End: last,
    }[event.key];
    const index = to ?? (event.key.length === 1 && event.key !== ' ' ? spelled(event) : null);
    if (index === null) return;
    focus(Math.min(last, Math.max(0, index)));
    event.preventDefault();
    event.stopPropagation();
  }

  function spelled({ key: letter, timeStamp }) {
    letters = { word: (timeStamp - letters.at < LETTERS_MS ? letters.word : '') + letter.toLowerCase(), at: timeStamp };
    const index = entries.findIndex(({ name }) => name.toLowerCase().startsWith(letters.word));
    return index < 0 ? current : index;
  }
}
