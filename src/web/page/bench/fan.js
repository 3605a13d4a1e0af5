/* A fan of rays through the scene: its form, its numbers, its drawing, and its paths over the image. The fan is traced
 * again when the scene changes, but not when the camera moves.
 * exports:
 *   createBenchFan(lab, bench, changed) -> {node}     sets bench.fan, the reply of /api/fan, while it is shown
 *   fanMarks(fan, {stroke(line, class), dot(point, class)}) -> SVG elements of that reply, over the image */

import { say } from '../shared/language.js';
import { showImage } from '../shared/images.js';
import { saveReply } from '../shared/save_file.js';
import {
  button,
  checkbox,
  choice,
  digits,
  element,
  empty,
  facts,
  notice,
  number,
  replace,
  vector,
} from '../shared/ui.js';
import { add, times, unit } from '../shared/vectors.js';
import { lineBetween, lineTo } from './ray_tree.js';

const POINTS = ['from', 'to'].flatMap((end) => ['x', 'y', 'z'].map((axis) => `${end} ${axis}`));
const PLANES = [
  ['', 'Automatic'],
  ['0,1,0', 'Level (normal y)'],
  ['0,0,1', 'Normal z'],
  ['1,0,0', 'Normal x'],
];

/* Rounding errors around zero are shown as 0, as by the program. */
const tidy = (x) => Math.round(x * 1e9) / 1e9 + 0;

export function createBenchFan(lab, bench, changed) {
  const values = [0, 0, 0, 1, 0, 0];
  const result = element('div', { class: 'bench-result', 'aria-live': 'polite' });
  const ends = POINTS.map((label, i) =>
    number({
      label: label[0].toUpperCase() + label.slice(1),
      value: 0,
      onchange: (value) => {
        values[i] = value;
        follow();
      },
    }),
  );
  const rays = number({ label: 'Rays', value: 21, min: 1, max: 1000, step: 1, onchange: follow });
  const width = number({ label: 'Width', value: 1, min: 0, onchange: follow });
  const spread = number({ label: 'Angle (°)', value: 20, min: 0, max: 179, onchange: follow });
  const shape = choice({
    label: 'Shape',
    radios: true,
    value: 'parallel',
    choices: [
      ['parallel', 'Parallel'],
      ['spread', 'From one point'],
    ],
    onchange: () => {
      showSize();
      follow();
    },
  });
  const plane = choice({ label: 'Plane of the rays', choices: PLANES, value: '', onchange: follow });
  const trees = checkbox('Draw reflected rays too', false, follow);
  const node = element(
    'div',
    { class: 'bench-fan' },
    element(
      'div',
      { class: 'buttons' },
      button('Trace', trace, { icon: 'trace', small: true, kind: 'primary' }),
      button('Along the beam', () => aim(alongBeam()), { small: true }),
      button('Across the view', () => aim(acrossView()), { small: true }),
    ),
    shape.node,
    element(
      'div',
      { class: 'bench-fields' },
      [...ends, rays, width, spread].map((field) => field.node),
    ),
    plane.node,
    trees.node,
    result,
  );
  let placed = false;
  let asking = false;
  let requested = '';
  lab.on('scene', follow);
  lab.on('restarted', remove);
  lab.view.behind(() => asking);
  showSize();
  return { node };

  function showSize() {
    width.node.hidden = shape.value === 'spread';
    spread.node.hidden = shape.value !== 'spread';
  }

  function place([from, to], size) {
    [...from, ...to].forEach((value, i) => {
      values[i] = Number(value.toPrecision(5));
      ends[i].set(values[i]);
    });
    if (size) width.set(Number(size.toPrecision(2)));
    placed = true;
  }

  /* A beam from left to right through what the camera looks at. */
  function acrossView() {
    const { view, camera } = lab.state;
    const pivot = view?.pivot || camera.target || [0, 0, 0];
    const distance = view?.distance || camera.distance || 1;
    const arm = times(unit(camera.right) || [1, 0, 0], 0.35 * distance);
    return [[add(pivot, times(arm, -1)), add(pivot, arm)], 0.12 * distance];
  }

  function alongBeam() {
    const of = (name) => lab.param(`${bench.beam}.${name}`)?.value;
    const [from, to] = [of('position'), of('target')];
    return from && to ? [[from, to], of('kind') === 'sheet' ? of('width') : 0] : null;
  }

  function aim(found) {
    if (!found) {
      replace(result, notice('The scene has no beam.', { remedy: 'add one above, or trace across the view' }));
      return;
    }
    place(...found);
    trace();
  }

  function question(drawing) {
    const size = shape.value === 'spread' ? `spread=${spread.value}` : `width=${width.value}`;
    const normal = plane.value ? `&plane=${plane.value}` : '';
    const tree = drawing && trees.value ? '&tree=1' : '';
    return `from=${values.slice(0, 3)}&to=${values.slice(3)}&rays=${rays.value}&${size}${normal}${tree}`;
  }

  function trace() {
    if (!placed) place(...acrossView());
    requested = '';
    bench.fan ||= { rays: [], crossings: [] };
    follow();
  }

  /* Sends one request at a time; a change during a request causes another one. */
  async function follow() {
    if (!bench.fan || asking || !lab.scene) return;
    const now = dependence();
    if (now === requested) return;
    asking = true;
    requested = now;
    try {
      const answer = await lab.get(`/api/fan?${question(false)}`);
      if (bench.fan) show(answer);
    } catch (error) {
      if (bench.fan) show(null, error);
    }
    asking = false;
    follow();
  }

  function dependence() {
    return `${lab.scene.version} ${question(true)}`;
  }

  function remove() {
    bench.fan = null;
    lab.view.note('fan', null);
    replace(result, empty('Not traced.'));
    changed();
  }

  function show(answer, error) {
    bench.fan = answer || { rays: [], crossings: [] };
    lab.view.note('fan', answer ? 'Fan of rays' : null, () => {
      remove();
      lab.view.stage.focus();
    });
    replace(
      result,
      error ? notice(error.message, { kind: 'error', remedy: error.remedy }) : [facts(numbers(answer)), drawing()],
    );
    changed();
  }

  function numbers({ rays: list, followed, crossings, focus }) {
    const bent = list.map((ray) => ray.deviation_deg).filter((angle) => angle !== null);
    return [
      ['Rays', say('{rays}, {followed} followed to the end', { rays: list.length, followed })],
      [
        'Deviation',
        bent.length
          ? say('{least}° to {most}°', { least: digits(Math.min(...bent), 6), most: digits(Math.max(...bent), 6) })
          : '–',
      ],
      ['Crossings of neighbours', say('{n} (the caustic)', { n: crossings.length })],
      [
        focus?.virtual ? 'Virtual mean focus' : 'Mean focus',
        focus ? vector(focus.at.map(tidy), 6) : 'none: parallel rays',
      ],
      ['Rms distance from the focus', focus ? say('{length} scene units', { length: digits(focus.rms, 3) }) : '–'],
    ];
  }

  /* The address changes with the scene, so that the browser requests it again. */
  function drawing() {
    const address = `/api/fan.svg?${question(true)}`;
    const image = element('img', {
      class: 'bench-drawing',
      alt: 'The rays in their plane: section of the solids, paths, crossings and mean focus',
    });
    showImage(lab, image, `${address}&of=${lab.scene.generation}`);
    return [
      image,
      element(
        'div',
        { class: 'buttons' },
        button('Save drawing', () => saveReply(lab, address, `${lab.name()}-fan.svg`), {
          icon: 'download',
          small: true,
        }),
        button('Save table', () => saveReply(lab, `/api/fan.csv?${question(false)}`, `${lab.name()}-fan.csv`), {
          icon: 'download',
          small: true,
        }),
      ),
    ];
  }
}

const CROSSINGS_MAX = 300;

/* The lines of a path; a path that ends in the scene (w is 1) ends at its last point. */
function linesOf({ points, far_end: farEnd }) {
  const lines = points.slice(1).map((point, i) => lineBetween(points[i], point));
  return farEnd[3] ? lines : [...lines, lineTo(points.at(-1), farEnd)];
}

export function fanMarks({ rays, crossings, focus }, { stroke, dot }) {
  return [
    ...rays.flatMap(linesOf).flatMap((line) => stroke(line, 'bench-fan-ray')),
    ...crossings.slice(0, CROSSINGS_MAX).flatMap(({ at }) => dot(at, 'bench-crossing')),
    ...(focus ? dot(focus.at, 'bench-focus') : []),
  ];
}
