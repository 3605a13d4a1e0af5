/* The panels next to the image, in groups by what a person does, and the splitter between them. The first row of tabs
 * has the groups, and the panels that stand alone; the second row has the panels of the chosen group. A panel is
 * created when it is first shown.
 * exports: createPanels(side, splitter, workspace, panels, lab) -> {select(id), chosen(), reveal()}
 *   reveal(): shows the image if a wide panel covers it
 *
 * A panel is {id, title, wide?, css?, start?(lab), create(root, lab), shown?(), hidden?()}:
 *   start    called once when the page opens, for tools of the image
 *   wide     the panel covers the image, too
 *   css      the path of its style sheet (FOLDER/panel_ID.css), which uses the variables of lab.css for all colours and
 *            begins each rule with .panel-ID; a site has all style sheets in its page, as #styles (src/web/site)
 * The panel's title is its h2: headings in it begin at h3. */

import { dragging } from './shared/escape.js';
import { say } from './shared/language.js';
import { element, icon, memory, notice, replace } from './shared/ui.js';

const NARROWEST = 300;
const SHORTEST = 120;
const IMAGE_WIDTH = 360; /* what remains for the image and the splitter */
const IMAGE_HEIGHT = 240;
const STEP = 24;
const FIRST = 'params';
const ICONS = { lessons: 'book', compare: 'halves' };
const GROUPS = [
  { id: 'build', title: 'Build', icon: 'blocks', panels: ['edit', 'params', 'slime'] },
  { id: 'rays', title: 'Rays', icon: 'prism', panels: ['bench', 'lens', 'pixel'] },
  { id: 'research', title: 'Research', icon: 'flask', panels: ['studies', 'machine'] },
];

export function createPanels(side, splitter, workspace, panels, lab) {
  const room = element('div', { class: 'panel-room', id: 'panels', tabindex: '-1' });
  const entries = new Map(panels.map((panel) => [panel.id, makeEntry(panel)]));
  const places = makePlaces(entries);
  const list = makeList('Panels', places);
  let chosen = null;

  room.append(...places.map((place) => place.frame));
  side.id = 'side';
  side.append(list, room);
  createSplitter(splitter, workspace);
  keepFitting(list);
  for (const entry of entries.values()) containFailure(entry, () => entry.panel.start?.(lab));
  select(
    entries.has(memory.get('panel'))
      ? memory.get('panel')
      : (panels.find((panel) => panel.id === FIRST) || panels[0])?.id,
  );
  return { select, chosen: () => chosen, reveal };

  function makeEntry(panel) {
    if (panel.css && !document.getElementById('styles'))
      document.head.append(element('link', { rel: 'stylesheet', href: panel.css }));
    const open = () => select(panel.id);
    const root = element('section', { class: `panel panel-${panel.id}`, tabindex: '0', 'aria-label': panel.title });
    const content = [element('h2', { class: 'visually-hidden', text: panel.title }), root];
    return { panel, root, open, created: false, ...makeTab(panel.id, panel.title, ICONS[panel.id], open, content) };
  }

  /* What the first row chooses from: groups, and panels without a group. */
  function makePlaces(entries) {
    const places = new Set();
    for (const [id, entry] of entries) {
      const about = GROUPS.find((group) => group.panels.includes(id));
      if (about && !entry.group) makeGroup(about, entries);
      places.add(entry.group ?? entry);
    }
    return [...places];
  }

  function makeGroup({ id, title, icon: drawing, panels: ids }, entries) {
    const members = ids.filter((each) => entries.has(each)).map((each) => entries.get(each));
    const key = `panel.${id}`;
    const last = members.find((member) => member.panel.id === memory.get(key)) ?? members[0];
    const open = () => group.last.open();
    const content = [makeList(title, members), members.map((member) => member.frame)];
    const group = { members, last, key, open, ...makeTab(id, title, drawing, open, content) };
    for (const member of members) member.group = group;
    return group;
  }

  /* A row of tabs, which the arrow keys go along. */
  function makeList(label, shown) {
    const row = element(
      'div',
      { class: label === 'Panels' ? 'tabs' : 'tabs inner', role: 'tablist', 'aria-label': label },
      shown.map((each) => each.tab),
    );
    row.addEventListener('keydown', (event) => {
      const now = shown.findIndex((each) => each.tab === event.target);
      const to = { ArrowRight: now + 1, ArrowLeft: now - 1, Home: 0, End: shown.length - 1 }[event.key];
      if (to === undefined || now < 0) return;
      const next = shown[(to + shown.length) % shown.length];
      next.open();
      next.tab.focus();
      event.preventDefault();
    });
    return row;
  }

  function show(entry, on) {
    mark(entry, on);
    containFailure(entry, () => {
      if (on && !entry.created) {
        entry.created = true;
        entry.panel.create(entry.root, lab);
      }
      (on ? entry.panel.shown : entry.panel.hidden)?.call(entry.panel);
    });
  }

  /* A failing panel does not affect the others. */
  function containFailure(entry, act) {
    try {
      act();
    } catch (error) {
      console.error(error);
      entry.created = true;
      replace(
        entry.root,
        notice(say('This panel failed: {why}', { why: error.message }), { kind: 'error', remedy: 'reload the page' }),
      );
    }
  }

  function select(id) {
    if (id === chosen || !entries.has(id)) return;
    if (chosen) show(entries.get(chosen), false);
    chosen = id;
    const entry = entries.get(id);
    workspace.classList.toggle('wide', Boolean(entry.panel.wide));
    for (const place of places) if (place.members) mark(place, place === entry.group);
    show(entry, true);
    if (entry.group) {
      entry.group.last = entry;
      memory.set(entry.group.key, id);
    }
    fit(list);
    for (const { tab } of [entry, entry.group ?? entry]) tab.scrollIntoView({ block: 'nearest', inline: 'nearest' });
    memory.set('panel', id);
    lab.emit('panel', id);
  }

  function reveal() {
    if (entries.get(chosen)?.panel.wide) select(FIRST);
  }
}

function makeTab(id, title, drawing, onclick, content) {
  const tab = element(
    'button',
    {
      type: 'button',
      role: 'tab',
      class: 'tab',
      id: `tab-${id}`,
      'aria-controls': `panel-${id}`,
      'aria-selected': 'false',
      tabindex: '-1',
      onclick,
    },
    drawing ? icon(drawing) : null,
    element('span', { text: title }),
  );
  const properties = { role: 'tabpanel', class: 'panel-frame', id: `panel-${id}`, 'aria-labelledby': tab.id };
  return { tab, frame: element('div', { ...properties, hidden: true }, ...content) };
}

function mark({ tab, frame }, on) {
  tab.setAttribute('aria-selected', String(on));
  tab.tabIndex = on ? 0 : -1;
  frame.hidden = !on;
}

/* Shows as much of the tabs as fits in one row: icons and words, words, words close together, or icons and the word of
 * the chosen tab. */
function fit(list) {
  for (const how of ['full', 'words', 'close', 'icons']) {
    list.dataset.fit = how;
    if (list.scrollWidth <= list.clientWidth) return;
  }
}

function keepFitting(list) {
  const again = () => fit(list);
  new ResizeObserver(again).observe(list);
  new MutationObserver(again).observe(list, { subtree: true, characterData: true, childList: true });
  document.fonts?.ready.then(again);
}

/* The splitter moves the left edge of the panels, or the upper edge if they are under the image (layout.css). */
function createSplitter(splitter, workspace) {
  const root = document.documentElement.style;
  const side = workspace.querySelector('.side');
  const sheet = matchMedia('(max-width: 900px) and (orientation: portrait), (max-width: 640px)');
  const kept = { width: memory.get('width', null), sheet: memory.get('sheet', null) };
  const about = () =>
    sheet.matches
      ? { name: 'sheet', variable: '--sheet', least: SHORTEST, room: workspace.clientHeight, rest: IMAGE_HEIGHT }
      : { name: 'width', variable: '--side', least: NARROWEST, room: workspace.clientWidth, rest: IMAGE_WIDTH };
  const here = () => side.getBoundingClientRect()[sheet.matches ? 'height' : 'width'];
  const apply = () => {
    const { name, variable, least, room, rest } = about();
    const largest = Math.max(least, room - rest);
    if (kept[name]) root.setProperty(variable, `${Math.round(Math.min(largest, Math.max(least, kept[name])))}px`);
    else root.removeProperty(variable);
    splitter.setAttribute('aria-orientation', sheet.matches ? 'horizontal' : 'vertical');
    splitter.setAttribute('aria-label', sheet.matches ? say('Height of the panels') : say('Width of the panels'));
    splitter.setAttribute('aria-valuemin', String(least));
    splitter.setAttribute('aria-valuemax', String(Math.round(largest)));
    splitter.setAttribute('aria-valuenow', String(Math.round(here())));
  };
  const set = (next) => {
    const { name } = about();
    kept[name] = next;
    memory.set(name, next);
    apply();
  };
  let endDrag = null;
  splitter.addEventListener('pointerdown', (event) => {
    const before = kept[about().name];
    splitter.setPointerCapture(event.pointerId);
    endDrag = dragging(() => {
      splitter.releasePointerCapture(event.pointerId);
      set(before);
    });
    event.preventDefault();
  });
  splitter.addEventListener('lostpointercapture', () => endDrag());
  splitter.addEventListener('pointermove', (event) => {
    if (!splitter.hasPointerCapture(event.pointerId)) return;
    const box = workspace.getBoundingClientRect();
    const half = splitter.getBoundingClientRect()[sheet.matches ? 'height' : 'width'] / 2;
    set(sheet.matches ? box.bottom - event.clientY - half : box.right - event.clientX - half);
  });
  splitter.addEventListener('dblclick', () => set(null));
  splitter.addEventListener('keydown', (event) => {
    const signs = { [sheet.matches ? 'ArrowUp' : 'ArrowLeft']: 1, [sheet.matches ? 'ArrowDown' : 'ArrowRight']: -1 };
    if (signs[event.key]) set(here() + signs[event.key] * STEP);
    else if (event.key === 'Home') set(null);
    else return;
    event.preventDefault();
  });
  new ResizeObserver(apply).observe(workspace);
}
