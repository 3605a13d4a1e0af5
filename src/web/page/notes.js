/* The linter's notes on the scene, fetched for each final image, and the notes on that image itself. A new note is
 * shown in the status line; the button there lists all. A remedy that sets parameters is a button that sets them.
 *
 * exports: createNotes(lab) -> {count(), show()}; emits 'notes' on the lab when the list has changed */

import { button, dialog, element } from './ui.js';
import { noteAction, noteReason } from './note_actions.js';

export function createNotes(lab) {
  let notes = [];
  let checkedGeneration = 0; /* the last generation that was checked */
  let openDialog = null;
  let said = null; /* the note in the status line, withdrawn when it is no longer true */

  const line = (note) => [note.place, note.text].filter(Boolean).join(': ');

  function actionOf(note) {
    const action = noteAction(note);
    if (!action) return null;
    const what = Object.entries(action.values).map(([path, value]) => `${path} is ${value}`);
    const done = () => lab.say(`${what.join(', ')}.`);
    return { label: action.label, act: () => lab.set(action.values).then(done, lab.fail) };
  }

  function actOn(note) {
    const action = actionOf(note);
    return action && element('p', {}, button(action.label, action.act, { small: true, kind: 'primary' }));
  }

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
              note.remedy ? element('span', { class: 'notes-remedy', text: ` Remedy: ${note.remedy}.` }) : null,
              noteReason(note).map((text) => element('p', { class: 'notes-remedy', text })),
              actOn(note),
            ),
          ),
        )
      : element('p', { text: 'No notes.' });

  async function ask() {
    const generation = lab.picture?.final ? lab.picture.generation : 0;
    if (!generation || generation === checkedGeneration) return;
    checkedGeneration = generation;
    const known = new Set(notes.map(line));
    const onImage = lab.picture.notes ?? [];
    try {
      notes = [...(await lab.get('/api/notes')).notes, ...onImage];
    } catch (error) {
      checkedGeneration = 0; /* a study is measuring, or the scene cannot be rendered: both are reported elsewhere */
      return;
    }
    const [first, ...more] = notes.filter((note) => !known.has(line(note)));
    const rest = more.length ? `; and ${more.length} more` : '';
    if (said && !notes.some((note) => line(note) === said.line)) {
      said.withdraw();
      said = null;
    }
    if (first && !openDialog)
      said = {
        line: line(first),
        withdraw: lab.say(`Note: ${line(first)}`, `${first.remedy}${rest}`, actionOf(first)),
      };
    if (openDialog) openDialog.node.querySelector('.dialog-body').replaceChildren(list());
    lab.emit('notes', notes);
  }

  lab.on('picture', ask);
  lab.on('restarted', () => {
    checkedGeneration = 0;
  });
  return {
    count: () => notes.length,
    show() {
      openDialog = dialog({ title: 'Notes on the scene', content: list() });
      openDialog.closed.then(() => {
        openDialog = null;
      });
    },
  };
}
