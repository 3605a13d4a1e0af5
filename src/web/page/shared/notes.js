/* The linter's notes on the scene, fetched for each final image, and the notes on that image itself. A new note is
 * shown in the status line, once in a tab and never again after it was dismissed; the button there lists all. On a
 * telephone the line has only their number. A remedy that sets parameters is a button that sets them.
 * exports:
 *   createNotes(lab) -> {count(), show()}               emits 'notes' on the lab when the list has changed
 *   depthNote(tree, lab) -> {text, label, values}       how much of a pixel's light the depth limit cuts off, as a note
 *                                                       and its remedy; null below 1 % */

import { session } from './address.js';
import { say, translated } from './language.js';
import { button, dialog, digits, element, memory } from './ui.js';

const SAID = 'notes.said'; /* of this tab */
const DISMISSED = 'notes.dismissed'; /* of this browser */
const REMEMBERED = 100;

const narrow = matchMedia('(max-width: 900px) and (orientation: portrait), (max-width: 640px)');
const framed = () => 'embed' in document.documentElement.dataset;
const remember = (list, line) => [...list.filter((each) => each !== line), line].slice(-REMEMBERED);

export function createNotes(lab) {
  let notes = [];
  let checkedGeneration = 0; /* the last generation that was checked */
  let openDialog = null;
  let said = null; /* the note in the status line, withdrawn when it is no longer true */

  const line = (note) => [note.place, note.text].filter(Boolean).join(': ');

  function actionOf(note) {
    const action = noteAction(note);
    if (!action) return null;
    const what = Object.entries(action.values).map(([path, value]) => say('{path} is {value}', { path, value }));
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
              element('span', { text: `${note.place ? ' ' : ''}${translated(note.text)}.` }),
              note.remedy
                ? element('span', {
                    class: 'notes-remedy',
                    text: ` ${say('Remedy: {remedy}.', { remedy: translated(note.remedy) })}`,
                  })
                : null,
              noteReason(note).map((text) => element('p', { class: 'notes-remedy', text })),
              actOn(note),
            ),
          ),
        )
      : element('p', { text: 'No notes.' });

  async function ask() {
    const generation = lab.image?.final ? lab.image.generation : 0;
    if (!generation || generation === checkedGeneration) return;
    checkedGeneration = generation;
    const known = new Set(notes.map(line));
    const onImage = lab.image.notes ?? [];
    try {
      notes = [...(await lab.get('/api/notes')).notes, ...onImage];
    } catch (error) {
      checkedGeneration = 0; /* a study is measuring, or the scene cannot be rendered: both are reported elsewhere */
      return;
    }
    const fresh = notes.filter((note) => !known.has(line(note)) && !isOld(line(note)));
    if (said && !notes.some((note) => line(note) === said.line)) {
      said.withdraw();
      said = null;
    }
    if (fresh.length && !openDialog && !framed()) tell(fresh);
    if (openDialog) openDialog.node.querySelector('.dialog-body').replaceChildren(list());
    lab.emit('notes', notes);
  }

  const isOld = (one) => [...(session.get(SAID) ?? []), ...memory.get(DISMISSED, [])].includes(one);

  function tell([first, ...more]) {
    const all = [first, ...more].map(line);
    const remedy = translated(first.remedy);
    const words = first.place
      ? say('Note: {place}: {text}', { place: first.place, text: translated(first.text) })
      : say('Note: {text}', { text: translated(first.text) });
    const how = {
      brief: narrow.matches,
      dismissed: () => memory.set(DISMISSED, all.reduce(remember, memory.get(DISMISSED, []))),
    };
    const withdraw = narrow.matches
      ? lab.say(
          more.length ? say('{n} notes on the scene', { n: all.length }) : 'A note on the scene',
          '',
          { label: 'Show', act: show },
          how,
        )
      : lab.say(
          words,
          more.length ? say('{remedy}; and {n} more', { remedy, n: more.length }) : remedy,
          actionOf(first),
          how,
        );
    session.set(SAID, all.reduce(remember, session.get(SAID) ?? []));
    said = { line: line(first), withdraw };
  }

  function show() {
    openDialog = dialog({ title: 'Notes on the scene', content: list() });
    openDialog.closed.then(() => {
      openDialog = null;
    });
  }

  lab.on('image', ask);
  lab.on('restarted', () => {
    checkedGeneration = 0;
  });
  return { count: () => notes.length, show };
}

const CUT_LEAST = 0.01;
const WITHOUT_LIMIT = { 'render.integrator': 'path', 'render.depth': 'unlimited' };

const labelOf = (path, value) =>
  path === 'render.depth'
    ? say('Raise the depth to {value}', { value })
    : say('Set {path} to {value}', { path, value });

function noteAction({ remedy }) {
  const set = /^set ([\w.-]+=[\w.+-]+(?: and [\w.-]+=[\w.+-]+)*)/.exec(remedy || '');
  if (!set) return null;
  const pairs = set[1].split(' and ').map((one) => one.split('='));
  const values = pairs.map(([path, text]) => [path, Number.isFinite(Number(text)) ? Number(text) : text]);
  const label =
    pairs.length === 1
      ? labelOf(...pairs[0])
      : say('Set {list}', { list: pairs.map((pair) => pair.join(' = ')).join(', ') });
  return { label, values: Object.fromEntries(values) };
}

function noteReason({ place }) {
  if (place !== 'render.depth') return [];
  return [
    'Rays end at the depth limit, and render.beyond replaces their light: by the sky, its mean, or black. So places ' +
      'seen through many surfaces or in several mirrors have a wrong colour. The panel Compare shows where: Cut light.',
    'An image that no longer changes with the depth may still be wrong: between two mirrors rays end at any depth.',
    'The default is 4, because a ray can split at each surface and the work can double with each level: 4 keeps an ' +
      'image fast while it is changed.',
  ];
}

export function depthNote(tree, lab) {
  const most = lab.param('render.depth').highest;
  const beyond = lab.param('render.beyond')?.value;
  const cut = tree.rays.filter(({ node }) => node.end === 'cut_depth');
  const fraction = cut.reduce((sum, { weight }) => sum + weight, 0);
  const { depth } = tree.answer;
  if (fraction < CUT_LEAST) return null;
  const percent = digits(100 * fraction, 2);
  const value = Math.min(most, Math.max(depth + 2, 2 * depth));
  return {
    text:
      beyond === 'black'
        ? say(
            "Rays with {percent} % of this pixel's weight end at the depth limit, {depth}, " +
              'and are black there, so the pixel is too dark.',
            { percent, depth },
          )
        : say(
            "Rays with {percent} % of this pixel's weight end at the depth limit, {depth}, " +
              'and have the colour of the sky there.',
            { percent, depth },
          ),
    ...(depth < most
      ? { label: labelOf('render.depth', value), values: { 'render.depth': value } }
      : { label: 'Use random paths without a limit', values: WITHOUT_LIMIT }),
  };
}
