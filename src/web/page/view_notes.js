/* Notes at the upper edge of the image that name what is drawn over it, each with a button that removes it.
 *
 * exports: createNotes() -> {node, note(name, text or null, onclose)}
 *   name: of the note; a later note of that name replaces it; null: removes it */

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
