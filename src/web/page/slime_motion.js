/* The motion of the slime compared with closed-form mechanics: what `cuvette motion` prints.
 * exports: createMotion(lab) -> {node} */

import { button, digits, download, element, notice, replace, table } from './ui.js';

function shown({ name, level, integrator, dt_s: step, values }) {
  return table({
    caption: `${name}: level ${level}, ${integrator}, steps of ${digits(step)} s`,
    columns: [
      'Property',
      { label: 'Measured', numeric: true },
      { label: 'Theory', numeric: true },
      { label: 'Error', numeric: true },
    ],
    rows: values.map(({ name: property, unit, what, measured, theory, error }) => [
      element('span', { title: `${what}${unit ? `, ${unit}` : ''}`, text: property }),
      digits(measured, 6),
      digits(theory, 6),
      digits(error, 2),
    ]),
  });
}

export function createMotion(lab) {
  const result = element('div', { class: 'slime-motion', 'aria-live': 'polite' });
  const measure = button('Measure', act, { icon: 'chart', small: true, kind: 'primary' });
  const stop = button('Stop', () => lab.post('/api/motion/stop', {}).catch(lab.fail), { icon: 'stop', small: true });
  const node = element(
    'div',
    { class: 'slime-motion' },
    element('p', {
      class: 'hint',
      text:
        'Springs, falls and free bodies with the stiffness, integrator and time step of the slime, without hands. ' +
        'About 2 s at level 4, four times as long for each further level, five times with the integrator implicit; ' +
        'at most 50 s.',
    }),
    element('div', { class: 'buttons' }, measure, stop),
    result,
  );
  stop.disabled = true;
  stop.hidden = lab.engine.kind === 'browser'; /* one thread computes, and answers when it is done */
  return { node };

  async function act() {
    measure.disabled = true;
    stop.disabled = false;
    replace(result, element('p', { class: 'hint', text: 'Measuring …' }));
    try {
      const { slimes, csv } = await lab.get('/api/motion');
      replace(result, slimes.map(shown), save(csv));
    } catch (error) {
      replace(result, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
    measure.disabled = false;
    stop.disabled = true;
  }

  function save(csv) {
    const name = `${lab.name()}-motion.csv`;
    return button('Save table', () => download(new Blob([csv], { type: 'text/csv' }), name), {
      icon: 'save',
      small: true,
    });
  }
}
