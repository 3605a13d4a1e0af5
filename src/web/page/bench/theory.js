/* Optics measured in the scene next to closed-form theory: a table of metrics, and curves.
 * exports: createBenchTheory(lab) -> {node} */

import { say } from '../shared/language.js';
import { createRenewal } from '../shared/renewal.js';
import { saveReply } from '../shared/save_file.js';
import { theoryChart, pretty } from '../shared/theory_chart.js';
import { button, choice, digits, element, notice, replace, table } from '../shared/ui.js';

const MARKS = { pass: '✓', FAIL: '✗' };
const WORDS = { pass: 'passes:', FAIL: 'fails:' };

const nameOf = ({ verdict, metric, unit, what, tolerance }) =>
  element(
    'span',
    {
      title: say('{what}; tolerance {tolerance}', {
        what: [what, unit].filter(Boolean).join(', '),
        tolerance: digits(tolerance, 2),
      }),
    },
    element('span', { class: `verdict ${verdict}`, role: 'img', 'aria-label': WORDS[verdict], text: MARKS[verdict] }),
    ` ${metric}`,
  );

function metrics({ values, defined, passed }) {
  const known = values.filter(({ verdict }) => verdict !== 'none');
  const missing = values.length - known.length;
  return [
    notice(say('{passed} of {defined} pass', { passed, defined }), {
      kind: passed === defined ? 'good' : 'warning',
      remedy: missing ? say('{n} more need other solids.', { n: missing }) : null,
    }),
    table({
      caption: 'Metrics: measured by rays of the program, and theory',
      columns: [
        'Metric',
        { label: 'Measured', numeric: true },
        { label: 'Theory', numeric: true },
        { label: 'Error', numeric: true },
      ],
      rows: known.map((value) => [
        nameOf(value),
        digits(value.measured, 7),
        digits(value.theory, 7),
        digits(value.error, 2),
      ]),
    }),
  ];
}

export function createBenchTheory(lab) {
  const result = element('div', { class: 'bench-result', 'aria-live': 'polite' });
  const curves = element('div', { class: 'bench-result' });
  const renewal = createRenewal(lab, result, act);
  const measure = button('Measure', renewal.run, { icon: 'ruler', small: true, kind: 'primary' });
  let curve = null;
  const node = element('div', { class: 'bench-theory' }, measure, renewal.node, result, curves);
  return { node };

  async function act() {
    measure.disabled = true;
    try {
      const answer = await lab.get('/api/realism');
      replace(result, metrics(answer), save('/api/realism.csv', 'realism'));
      offer(answer.curves);
      return true;
    } catch (error) {
      replace(result, notice(error.message, { kind: 'error', remedy: error.remedy }));
      replace(curves);
      return false;
    } finally {
      measure.disabled = false;
    }
  }

  function save(address, name) {
    return button('Save table', () => saveReply(lab, address, `${lab.name()}-${name}.csv`), {
      icon: 'download',
      small: true,
    });
  }

  function offer(list) {
    const drawn = element('div', { class: 'bench-result', 'aria-live': 'polite' });
    curve = (list.find(({ name }) => name === curve?.name) || list[0]) ?? null;
    const draw = () => show(drawn);
    const which = choice({
      label: 'Curve',
      choices: list.map(({ name, y }) => [name, pretty(y)]),
      value: curve?.name,
      onchange: (name) => {
        curve = list.find((each) => each.name === name);
        draw();
      },
    });
    replace(curves, curve ? [which.node, drawn] : null);
    if (curve) draw();
  }

  async function show(place) {
    const of = curve;
    try {
      const answer = await lab.get(`/api/realism/${of.name}`);
      if (of !== curve) return;
      replace(
        place,
        theoryChart({ title: pretty(of.y), measure: of }, answer),
        save(`/api/realism/${of.name}/points.csv`, of.name),
      );
    } catch (error) {
      replace(place, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
  }
}
