/* What lies over the picture that is not the picture: a note of it at the upper edge, with a button that takes it away.
 *
 * exports: createNotes() -> {node, note(name, text or null, onclose)}
 *   name: of the note, which a later one of that name takes the place of; null: it goes */

import { button, element } from './ui.js';

export function createNotes() {
  const node = element('div', { class: 'view-notes' });
  const notes = new Map();
  return { node, note };

  function note(name, text, onclose) {
    const old = notes.get(name);
    if (text !== null && old?.text === text) return;
    old?.node.remove();
    notes.delete(name);
    if (text === null) return;
    const made = element(
      'div',
      { class: 'view-note' },
      element('span', { text }),
      button(`Close: ${text}`, onclose, { icon: 'close', bare: true, small: true, kind: 'quiet' }),
    );
    notes.set(name, { text, node: made });
    node.append(made);
  }
}
