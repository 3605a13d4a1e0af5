/* The panel Machine: processors, clocks, and current disturbances of measurements. exports: panel */

import { say } from '../shared/language.js';
import { needsProgram } from '../shared/commands.js';
import { button, element, facts, group, notice, replace, seconds } from '../shared/ui.js';

let refresh = null;
let loaded = false;

/* Splits "1 package, 2 cores, .., Intel(R) .." into one item per line. */
const topology = (text) =>
  element(
    'ul',
    { class: 'plain-list' },
    text.split(', ').map((part) => element('li', { text: part })),
  );

const clock = ({ tick_s: tick, overhead_s: overhead }) =>
  say('resolution {tick}, cost of a reading {cost}', { tick: seconds(tick), cost: seconds(overhead) });

function disturbances(list) {
  if (!list.length) return notice('No disturbances of measurements were found.', { kind: 'good' });
  return list.map((text) => notice(text, { kind: 'warning' }));
}

function draw(place, report) {
  replace(
    place,
    element('h3', { text: 'Current disturbances of measurements' }),
    element('div', { class: 'notices' }, disturbances(report.disturbances)),
    group(
      'Processors',
      { id: 'machine-processors' },
      facts([
        [
          'Topology',
          report.machine
            ? topology(report.machine)
            : say('{packages} packages, {cores} cores, {units} processing units', report),
        ],
        [
          'Vector instructions',
          report.isa === report.isa_best ? report.isa : say('{isa}; this machine supports {isa_best}', report),
        ],
        ['Hardware counters', report.hardware_counters ? 'available' : 'not available'],
      ]),
    ),
    group(
      'Clocks',
      { id: 'machine-clocks' },
      facts([
        ['Wall clock', clock(report.wall_clock)],
        ['CPU time of a thread', clock(report.thread_clock)],
      ]),
    ),
    group(
      'System and program',
      { id: 'machine-program' },
      facts([
        ['Kernel', report.kernel.join(' ')],
        ['Cuvette', report.version],
        ['Compiler', report.compiler],
        ['Compiler options', report.flags],
      ]),
    ),
  );
}

/* A page can learn little about the machine, and a browser may report less than there is. */
function createElsewhere(root, lab) {
  root.append(
    element(
      'div',
      { class: 'machine' },
      needsProgram(lab, 'Only the program sees the clocks, counters and disturbances of a machine.', [
        'cuvette machine',
      ]),
      group(
        'This browser',
        { id: 'machine-browser' },
        facts([
          ['Processors', navigator.hardwareConcurrency || 'not reported'],
          ['Browser', navigator.userAgent],
          ['Cuvette', lab.state?.version],
        ]),
      ),
    ),
  );
  loaded = true;
}

function create(root, lab) {
  if (lab.engine.kind === 'server') createReport(root, lab);
  else createElsewhere(root, lab);
}

function createReport(root, lab) {
  const place = element('div', { class: 'machine', 'aria-live': 'polite' });
  const again = button('Refresh', () => refresh(), {
    icon: 'refresh',
    title: 'takes half a second to measure the load from other programs',
  });
  const when = element('span', { class: 'hint' });
  root.append(element('div', { class: 'buttons' }, again, when), place);
  refresh = async () => {
    if (again.disabled) return;
    again.disabled = true;
    root.setAttribute('aria-busy', 'true');
    try {
      draw(place, await lab.get('/api/machine'));
      when.textContent = say('as of {time}', { time: new Date().toLocaleTimeString(document.documentElement.lang) });
      loaded = true;
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
  css: 'studies/panel_machine.css',
  create,
  shown() {
    if (!loaded) refresh();
  },
};
