/* The first card of the gallery: an empty optical bench in two dimensions, with the palette next to it.
 * exports: freeCard(lab) -> node */

import { element, svg } from '../shared/ui.js';

const BEAM_HEIGHT = 2.5; /* of the scene {new: 'bench'}, in its units, centimetres */
const WINDOW = [-20, 20, -12, 12];

const drawing = () =>
  svg(
    'svg',
    { class: 'thumbnail palette-drawing', viewBox: '0 0 120 90', 'aria-hidden': 'true', focusable: 'false' },
    svg('path', { class: 'ray', d: 'M4 30H44L116 62M4 45H116M4 60H44L116 28' }),
    svg('path', { class: 'glass', d: 'M44 18Q62 45 44 72Q26 45 44 18Z' }),
    svg('path', { class: 'glass', d: 'M92 6L106 30H78Z' }),
    svg('path', { class: 'metal', d: 'M84 82L106 70L108 73L86 85Z' }),
  );

export function freeCard(lab) {
  return element(
    'button',
    { type: 'button', class: 'lesson-card free-card', onclick: open },
    drawing(),
    element('span', { class: 'lesson-card-title', text: 'Free experiment' }),
    element('span', {
      class: 'lesson-card-question',
      text: 'An empty bench: add lenses, prisms, mirrors and light, and see what happens.',
    }),
  );

  async function open() {
    try {
      if (lab.state && !lab.state.saved) lab.say('Undo restores the previous scene.');
      await lab.change('/api/open', { new: 'bench' });
      lab.choice?.choose('');
      lab.panels.select('edit');
      await lab.section.open('top', { at: BEAM_HEIGHT, window: WINDOW });
    } catch (error) {
      lab.fail(error);
    }
  }
}
