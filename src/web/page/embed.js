/* The page in a frame of another page, such as that of a learning platform: with ?embed=1 in its address it shows the
 * image with its tools, and the lesson that the address names, without head, tabs and facts.
 * exports: createEmbed(footer, lab)      call it when lab.panels exists */

import { named } from './shared/address.js';
import { element, write } from './shared/ui.js';

const root = document.documentElement;
const embedded = new URLSearchParams(location.search).get('embed') === '1';
if (embedded) root.dataset.embed = 'image';

const REST_MS = 500; /* the link is renewed when the scene has not changed for this time */

export function createEmbed(footer, lab) {
  if (!embedded) return;
  const { panels } = lab;
  const show = (id) => {
    root.dataset.embed = id === 'lessons' ? 'lesson' : 'image';
  };
  /* There are no tabs to leave another panel. */
  lab.panels = { ...panels, select: (id) => id === 'lessons' && panels.select(id) };
  lab.on('panel', show);
  show(named().lesson ? 'lessons' : panels.chosen());
  footer.append(createLink(lab));
  const title = element('h1', { text: 'Cuvette' }); /* that of the head is hidden */
  document.body.prepend(element('header', { class: 'visually-hidden' }, title));
  lab.on('state', (state) => write(title, { textContent: state.title || 'Cuvette' }));
}

/* To the whole laboratory. The program has the scene; in a browser the link holds it, with its changes. */
function createLink(lab) {
  const own = location.pathname;
  const link = element('a', { class: 'embed-link', target: '_blank', rel: 'noopener', text: 'Open in Cuvette' });
  let timer = 0;
  const renew = async () => {
    const { generation, undo } = lab.state;
    const changed = undo && lab.engine.kind === 'browser' && !(named().lesson && lab.state.saved);
    const { fragment, code } = changed ? await lab.get('/api/link').catch(() => ({})) : {};
    if (generation === lab.state.generation) link.href = own + (code ? fragment + code : location.hash);
  };
  link.href = own + location.hash;
  lab.on('state', () => {
    clearTimeout(timer);
    timer = setTimeout(renew, REST_MS);
  });
  return link;
}
