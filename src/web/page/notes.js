/* The linter's notes on the scene: asked for with each final picture. A new one is told in the status line; the button
 * there lists all.
 *
 * exports: createNotes(lab) -> {count(), show()}; emits 'notes' on the lab when the list has changed */

import { dialog, element } from './ui.js';

export function createNotes(lab) {
  let notes = [];
  let asked = 0; /* the generation that was asked about */
  let dialogue = null;

  const line = (note) => [note.place, note.text].filter(Boolean).join(': ');

  const list = () =>
    notes.length
      ? element(
          'ul',
          { class: 'notes' },
          notes.map((note) =>
            element(
              'li',
              {},
              note.place ? element('code', { text: note.place }) : null,
              element('span', { text: `${note.place ? ' ' : ''}${note.text}.` }),
              note.remedy ? element('span', { class: 'notes-remedy', text: ` What to do: ${note.remedy}.` }) : null,
            ),
          ),
        )
      : element('p', { text: 'There is nothing to note.' });

  async function ask() {
    const generation = lab.picture?.final ? lab.picture.generation : 0;
    if (!generation || generation === asked) return;
    asked = generation;
    const known = new Set(notes.map(line));
    try {
      ({ notes } = await lab.get('/api/notes'));
    } catch (error) {
      asked = 0; /* a study measures, or the scene cannot be rendered: that is told elsewhere */
      return;
    }
    const [first, ...more] = notes.filter((note) => !known.has(line(note)));
    if (first) lab.say(`Note: ${line(first)}`, more.length ? `${first.remedy}; and ${more.length} more` : first.remedy);
    if (dialogue) dialogue.node.querySelector('.dialog-body').replaceChildren(list());
    lab.emit('notes', notes);
  }

  lab.on('picture', ask);
  lab.on('afresh', () => {
    asked = 0;
  });
  return {
    count: () => notes.length,
    show() {
      dialogue = dialog({ title: 'Notes on the scene', content: list() });
      dialogue.closed.then(() => {
        dialogue = null;
      });
    },
  };
}
