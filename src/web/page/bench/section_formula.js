/* The lens formula with what is measured in a section: a card over the drawing while light passes one lens or meets one
 * curved mirror. exports: createFormula(lab, section, stage) -> {show(images)} */

import { say } from '../shared/language.js';
import { digits, element, memory, replace, write } from '../shared/ui.js';

const NARROW_PX = 600;

export function createFormula(lab, section, stage) {
  const body = element('div');
  const card = element(
    'details',
    { class: 'section-formula', hidden: true },
    element('summary', { text: '1/a + 1/b = 1/f' }),
    body,
  );
  card.addEventListener('pointerdown', (event) => event.stopPropagation());
  card.addEventListener('toggle', () => stage.clientWidth >= NARROW_PX && memory.set('section.formula', card.open));
  stage.append(card);
  let sized = false;
  let shown = '';
  return { show };

  function show(images) {
    const { formula, point } = images.find((image) => image.formula) || {};
    write(card, { hidden: !formula });
    if (!formula) return;
    if (!sized) card.open = stage.clientWidth >= NARROW_PX && memory.get('section.formula', true);
    sized = true;
    const { a, b, f } = formula;
    const unit = unitOf(section.unitM);
    const sum = (point ? 1 / a : 0) + 1 / b;
    const rows = [
      ['a', point ? `${digits(a, 4)} ${unit}` : say('∞ (parallel light)')],
      ['b', `${digits(b, 4)} ${unit}`],
      ['f', `${digits(f, 4)} ${unit}`],
      ['1/a + 1/b', `${digits(sum, 4)} /${unit}`],
      ['1/f', `${digits(1 / f, 4)} /${unit}`],
    ];
    const now = JSON.stringify([formula.solid, formula.mirror, rows]);
    if (now === shown) return;
    shown = now;
    replace(
      body,
      element(
        'dl',
        { class: 'facts' },
        rows.map(([name, value]) => [element('dt', { text: name }), element('dd', { text: value })]),
      ),
      element('p', {
        class: 'hint',
        text: formula.mirror
          ? say('{mirror}: a and b are measured to the mirror, f is half its radius.', { mirror: formula.solid })
          : say('{lens}: a and b are measured to its principal planes, f follows from its radii.', {
              lens: formula.solid,
            }),
      }),
      element('p', {
        class: 'hint',
        text: 'Signs: b above 0 for a real image, below 0 for a virtual one; f above 0 if it collects light.',
      }),
    );
  }
}

const unitOf = (metres) =>
  [
    ['m', 1],
    ['dm', 0.1],
    ['cm', 0.01],
    ['mm', 0.001],
  ].find(([, size]) => Math.abs(metres / size - 1) < 1e-9)?.[0] || say('units');
