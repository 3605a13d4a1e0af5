/* The machine: its processors and clocks, and what would disturb a measurement now. exports: panel */

import { button, element, facts, group, notice, replace, seconds } from './ui.js';

let refresh = null;
let asked = false;

/* "1 package, 2 cores, .., Intel(R) ..": a part a line. */
const topology = (text) =>
  element(
    'ul',
    { class: 'plain-list' },
    text.split(', ').map((part) => element('li', { text: part })),
  );

const clock = ({ tick_s: tick, overhead_s: overhead }) =>
  `steps of ${seconds(tick)}, a reading costs ${seconds(overhead)}`;

function disturbances(list) {
  if (!list.length) return notice('Nothing was found that would disturb a measurement.', { kind: 'good' });
  return list.map((text) => notice(text, { kind: 'warning' }));
}

function draw(place, told) {
  replace(
    place,
    element('h3', { text: 'What disturbs measurements now' }),
    element('div', { class: 'notices' }, disturbances(told.disturbances)),
    group(
      'Processors',
      { id: 'machine-processors' },
      facts([
        [
          'Topology',
          told.machine
            ? topology(told.machine)
            : `${told.packages} packages, ${told.cores} cores, ${told.units} processing units`,
        ],
        [
          'Vector instructions',
          told.isa === told.isa_best ? told.isa : `${told.isa}; this machine has ${told.isa_best}`,
        ],
        ['Hardware counters', told.hardware_counters ? 'there are some' : 'the system gives none'],
      ]),
    ),
    group(
      'Clocks',
      { id: 'machine-clocks' },
      facts([
        ['Wall clock', clock(told.wall_clock)],
        ['CPU time of a thread', clock(told.thread_clock)],
      ]),
    ),
    group(
      'System and program',
      { id: 'machine-program' },
      facts([
        ['Kernel', told.kernel.join(' ')],
        ['Cuvette', told.version],
        ['Compiler', told.compiler],
        ['Built as', told.flags],
      ]),
    ),
  );
}

function create(root, lab) {
  const place = element('div', { class: 'machine', 'aria-live': 'polite' });
  const again = button('Refresh', () => refresh(), {
    icon: 'reset',
    title: 'takes half a second, in which the load of others is watched',
  });
  const when = element('span', { class: 'hint' });
  root.append(element('div', { class: 'buttons' }, again, when), place);
  refresh = async () => {
    if (again.disabled) return;
    again.disabled = true;
    root.setAttribute('aria-busy', 'true');
    try {
      draw(place, await lab.get('/api/machine'));
      when.textContent = `as of ${new Date().toLocaleTimeString()}`;
      asked = true;
    } catch (error) {
      replace(place, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
    again.disabled = false;
    root.removeAttribute('aria-busy');
  };
}

export const panel = {
  id: 'machine',
  title: 'Machine',
  css: 'panel_machine.css',
  create,
  shown() {
    if (!asked) refresh();
  },
};
