/* The panels as tabs next to the image, and the splitter between them. A panel is created when it is first shown.
 * exports: createPanels(side, splitter, workspace, panels, lab) -> {select(id), chosen(), reveal()}
 *   reveal(): shows the image if a wide panel covers it
 *
 * A panel is {id, title, wide?, css?, start?(lab), create(root, lab), shown?(), hidden?()}:
 *   start    called once when the page opens, for tools of the image
 *   wide     the panel covers the image, too
 *   css      the path of its style sheet (FOLDER/panel_ID.css), which uses the variables of lab.css for all colours and
 *            begins each rule with .panel-ID; a site has all style sheets in its page, as #styles (src/web/site)
 * The panel's title is its h2: headings in it begin at h3. */

import { element, memory, notice, replace } from './shared/ui.js';

const NARROWEST = 300;
const SHORTEST = 120;
const IMAGE_WIDTH = 360; /* what remains for the image and the splitter */
const IMAGE_HEIGHT = 240;
const STEP = 24;
const FIRST = 'params';

export function createPanels(side, splitter, workspace, panels, lab) {
  const list = element('div', { class: 'tabs', role: 'tablist', 'aria-label': 'Panels' });
  const entries = new Map(panels.map((panel) => [panel.id, makeEntry(panel)]));
  let chosen = null;

  list.append(...[...entries.values()].map((entry) => entry.tab));
  list.addEventListener('keydown', key);
  side.id = 'side';
  side.append(
    list,
    element(
      'div',
      { class: 'panel-room', id: 'panels', tabindex: '-1' },
      [...entries.values()].map((entry) => entry.frame),
    ),
  );
  createSplitter(splitter, workspace);
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
    const tab = element('button', {
      type: 'button',
      role: 'tab',
      class: 'tab',
      id: `tab-${panel.id}`,
      'aria-controls': `panel-${panel.id}`,
      'aria-selected': 'false',
      tabindex: '-1',
      onclick: () => select(panel.id),
      text: panel.title,
    });
    const root = element('section', { class: `panel panel-${panel.id}`, tabindex: '0', 'aria-label': panel.title });
    const frame = element(
      'div',
      {
        role: 'tabpanel',
        class: 'panel-frame',
        id: `panel-${panel.id}`,
        'aria-labelledby': `tab-${panel.id}`,
        hidden: true,
      },
      element('h2', { class: 'visually-hidden', text: panel.title }),
      root,
    );
    return { panel, tab, root, frame, created: false };
  }

  function show(entry, on) {
    entry.tab.setAttribute('aria-selected', String(on));
    entry.tab.tabIndex = on ? 0 : -1;
    entry.frame.hidden = !on;
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
      replace(entry.root, notice(`This panel failed: ${error.message}`, { kind: 'error', remedy: 'reload the page' }));
    }
  }

  function select(id) {
    if (id === chosen || !entries.has(id)) return;
    if (chosen) show(entries.get(chosen), false);
    chosen = id;
    workspace.classList.toggle('wide', Boolean(entries.get(id).panel.wide));
    show(entries.get(id), true);
    entries.get(id).tab.scrollIntoView({ block: 'nearest', inline: 'nearest' });
    memory.set('panel', id);
    lab.emit('panel', id);
  }

  function reveal() {
    if (entries.get(chosen)?.panel.wide) select(FIRST);
  }

  function key(event) {
    const ids = [...entries.keys()];
    const now = ids.indexOf(chosen);
    const to = {
      ArrowRight: now + 1,
      ArrowLeft: now - 1,
      ArrowDown: now + 1,
      ArrowUp: now - 1,
      Home: 0,
      End: ids.length - 1,
    }[event.key];
    if (to === undefined) return;
    select(ids[(to + ids.length) % ids.length]);
    entries.get(chosen).tab.focus();
    event.preventDefault();
  }
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
    splitter.setAttribute('aria-label', sheet.matches ? 'Height of the panels' : 'Width of the panels');
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
  splitter.addEventListener('pointerdown', (event) => {
    splitter.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
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
