/* The step of a lesson in which the pupil measures by hand: the tool in the section, its reading, and the comparison
 * with theory.
 * exports: createHandStep(lab, lesson, {taken, truth(), take(reading)}) -> {node, draw(), end()}
 *   taken: {value, truth} of the reading that was used, or nothing; truth(): the value by theory now */

import { say } from '../shared/language.js';
import { button, digits, element, notice, replace, write } from '../shared/ui.js';

const unitOf = ({ unit }) => (unit === 'deg' ? '°' : unit ? ` ${unit}` : '');

export function createHandStep(lab, lesson, { taken, truth, take }) {
  const { hand } = lesson;
  if (!hand || !lab.section) return { node: null, draw() {}, end() {} };
  const { tools } = lab.section;
  let used = taken;
  const value = element('output', { class: 'lesson-hand-value' });
  const use = button('Use this reading', accept, { kind: 'primary', small: true });
  const open = button('Show the rays', show, { icon: 'section', small: true });
  const verdict = element('div', { 'aria-live': 'polite' });
  const node = element(
    'div',
    { class: 'lesson-step lesson-hand' },
    element('h4', { text: 'Measure it yourself' }),
    element('p', { text: hand.ask }),
    element('div', { class: 'buttons' }, value, use, open),
    verdict,
  );
  tools.take(hand);
  const ends = [tools.on(draw), lab.on('section', draw), () => tools.put()];
  draw();
  return { node, draw, end: () => ends.forEach((end) => end()) };

  function show() {
    lab.section.present(lesson.show);
    tools.take(hand);
  }

  function accept() {
    used = { value: tools.reading, truth: truth() };
    take(used);
    lab.section.draw();
  }

  function draw() {
    const { reading } = tools;
    const known = reading !== null && Number.isFinite(truth());
    write(value, { textContent: reading === null ? '–' : `${digits(reading, 4)}${unitOf(hand)}` });
    use.disabled = !known;
    open.hidden = lab.section.shown;
    if (used) lab.section.marks = { ...lesson.show, angles: lesson.show.normals };
    replace(verdict, used ? judged() : null);
  }

  /* A reading stays marked; after a change of the scene it is compared with what was true then. */
  function judged() {
    const off = used.value - used.truth;
    const good = Math.abs(off) <= hand.within;
    const words = {
      value: `${digits(used.value, 4)}${unitOf(hand)}`,
      theory: `${digits(used.truth, 4)}${unitOf(hand)}`,
      off: `${digits(Math.abs(off), 3)}${unitOf(hand)}`,
    };
    const stale = Math.abs(truth() - used.truth) > 0.02 * hand.within;
    const text = stale
      ? say('You measured {value} before the scene was changed. Measure again.', words)
      : good
        ? say('You measured {value}. That agrees with theory: {theory}.', words)
        : off < 0
          ? say('You measured {value}. That is {off} too small: try again.', words)
          : say('You measured {value}. That is {off} too large: try again.', words);
    return notice(text, { kind: good && !stale ? 'good' : 'info' });
  }
}
