/* The panel Bench: beams and lasers, their paths over the image, the numbers at each hit, ruler, protractor, screen, a
 * fan of rays, and the scene's optics compared with theory.
 * exports: panel. The tool Bench chooses a segment by a click; with Measure on, it sets points. */

import { say } from '../shared/language.js';
import { createRow } from '../edit/param_row.js';
import { button, checkbox, digits, element, empty, facts, group, notice, replace, table } from '../shared/ui.js';
import { createPointHandles } from '../view/point_handles.js';
import { createBenchFan } from './fan.js';
import { hitFacts, measure } from './measure.js';
import { createBenchOverlay } from './overlay.js';
import { describe, isCut } from './ray_tree.js';
import { createBenchRays } from './rays.js';
import { createBenchScreen } from './screen.js';
import { createSection } from './section.js';
import { createBenchTheory } from './theory.js';

const FIELD_GRID = { kind: 'bundle', rays: 25, pattern: 'square', field_columns: 3, field_rows: 3 };
const bench = { rays: null, chosen: null, points: [], screen: null, fan: null, measuring: false, beam: '' };
const listeners = new Set();
let overlay = null;
let handles = null;

function changed() {
  overlay.draw();
  handles.draw();
  for (const listener of listeners) listener();
}

function choose(segment) {
  bench.chosen = segment;
  if (segment) bench.beam = segment.beam;
  changed();
}

function start(lab) {
  bench.rays = createBenchRays(lab);
  overlay = createBenchOverlay(lab, bench);
  handles = createPointHandles(lab, { list: () => endsOf(lab, bench.beam), symbol: 'beam', what: 'point of a beam' });
  bench.rays.on(() => {
    bench.chosen = sameSegment(bench.chosen);
    changed();
  });
  lab.on('view', () => overlay.draw());
  lab.on('state', () => overlay.draw());
  createSection(lab);
  lab.view.tool('bench', {
    label: 'Bench',
    icon: 'beam',
    order: 45,
    cursor: 'crosshair',
    hint:
      'Aim beams of light, and measure: click a beam, then drag its start or its target. ' +
      'Shift: nearer and farther',
    chosen() {
      lab.panels?.select('bench');
      handles.show();
    },
    dropped: handles.hide,
    down: (point) => {
      pick(lab, point);
      return false;
    },
    key: (event) => {
      if (event.key !== 'Escape') return false;
      bench.points = [];
      choose(null);
      return true;
    },
  });
}

/* The draggable ends of a beam; none while the ruler's points are set. */
function endsOf(lab, beam) {
  if (bench.measuring) return [];
  return [
    { path: `${beam}.position`, name: say('start of {beam}', { beam }) },
    { path: `${beam}.target`, name: say('target of {beam}', { beam }) },
  ].filter(({ path }) => beam && lab.param(path));
}

/* After a change of the scene: the segment at the same place in the trees. */
function sameSegment(before) {
  return (
    before &&
    (bench.rays.segments.find(
      ({ beam, ray, one }) =>
        beam === before.beam &&
        ray.number === before.ray.number &&
        ray.lambda_nm === before.ray.lambda_nm &&
        one.index === before.one.index,
    ) ||
      null)
  );
}

/* A point on a beam, or on the surface that the image shows there. */
async function pick(lab, point) {
  const found = overlay.nearest(point);
  if (!bench.measuring) {
    choose(found?.segment || null);
    return;
  }
  let at = found?.at;
  if (!at && point.inside) {
    try {
      at = (await lab.get(`/api/trace?x=${Math.floor(point.x)}&y=${Math.floor(point.y)}`)).root.hit?.point;
    } catch (error) {
      lab.fail(error);
    }
  }
  if (!at) return;
  bench.points = bench.points.length === 3 ? [at] : [...bench.points, at];
  changed();
}

/* --- the panel --- */

async function attempt(lab, promise) {
  try {
    return await promise;
  } catch (error) {
    lab.fail(error);
    return null;
  }
}

function createBeams(lab) {
  const list = element('div', { class: 'buttons', role: 'group', 'aria-label': 'Beams' });
  const rows = element('div', { class: 'panel-params object-rows' });
  let controls = [];
  let shown = '';
  const selectBeam = (name) => {
    bench.beam = name;
    changed();
  };
  const addBeam = async (set) => {
    const reply = await attempt(lab, lab.change('/api/objects', { kind: 'beam' }));
    if (!reply?.name) return;
    bench.beam = reply.name;
    lab.view.use('bench');
    const values = Object.fromEntries(Object.entries(set).map(([key, value]) => [`${reply.name}.${key}`, value]));
    if (Object.keys(values).length) await attempt(lab, lab.set(values));
  };
  const remove = () => attempt(lab, lab.del(`/api/objects/${encodeURIComponent(bench.beam)}`));
  const node = element(
    'div',
    {},
    element(
      'div',
      { class: 'buttons', role: 'group', 'aria-label': 'Add a beam' },
      button('Laser', () => addBeam({}), { icon: 'plus', small: true }),
      button('Fan', () => addBeam({ kind: 'fan', rays: 9 }), { icon: 'plus', small: true }),
      button('Sheet', () => addBeam({ kind: 'sheet', rays: 9 }), { icon: 'plus', small: true }),
      button('White sheet', () => addBeam({ kind: 'sheet', rays: 3, white: 'on' }), { icon: 'plus', small: true }),
      button('Field grid', () => addBeam(FIELD_GRID), {
        icon: 'plus',
        small: true,
        title: 'Parallel beams from a grid of 3 x 3 field points',
      }),
      button('Bundle', () => addBeam({ kind: 'bundle', rays: 60 }), { icon: 'plus', small: true }),
    ),
    list,
    rows,
  );
  return { node, show };

  function show() {
    const beams = (lab.scene?.objects || []).filter((object) => object.kind === 'beam').map((object) => object.name);
    if (!beams.includes(bench.beam)) bench.beam = beams[0] || '';
    replace(
      list,
      beams.map((name) =>
        button(name, () => selectBeam(name), { small: true, pressed: name === bench.beam, translate: 'no' }),
      ),
      bench.beam
        ? button(say('Remove {name}', { name: bench.beam }), remove, { icon: 'trash', small: true, kind: 'danger' })
        : null,
    );
    const beamRows = (lab.scene?.params || []).filter((row) => bench.beam && row.path === `${bench.beam}.${row.name}`);
    const now = beamRows.map((row) => row.path).join();
    if (now === shown) {
      for (const row of controls) if (lab.param(row.path)) row.update(lab.param(row.path), lab.scene.generation);
      return;
    }
    shown = now;
    controls = beamRows.map((row) => createRow(row, lab));
    replace(
      rows,
      controls.length
        ? group(
            'Parameters of the beam',
            { id: 'bench.beam', open: false },
            controls.map((row) => row.node),
          )
        : empty(
            'The scene has no beams. Add one: a beam is shown over the image and saved with the scene; with its ' +
              'parameter lights on, it also lights the scene.',
          ),
    );
  }
}

function hitRows(segments) {
  return segments.map((segment) => {
    const words = describe(segment.one);
    const name = `${segment.one.level === 1 ? say('start') : words.kind}: ${words.surface || words.end}`;
    return [
      /* The click handler of the row chooses the segment. */
      button(name, () => {}, { small: true, kind: 'quiet', pressed: segment === bench.chosen }),
      words.angles,
      words.reflectance,
      words.transmitted,
      digits(segment.power, 3),
    ];
  });
}

function createNumbers() {
  const node = element('div', { class: 'bench-numbers' });
  return {
    node,
    show() {
      const { chosen, rays } = bench;
      if (!rays.segments.length && !rays.error) return replace(node, empty('The hits of a beam are shown here.'));
      if (rays.error) return replace(node, notice(rays.error.message, { kind: 'error', remedy: rays.error.remedy }));
      const first = chosen || rays.segments.find(({ beam }) => beam === bench.beam) || rays.segments[0];
      const sameRay = rays.segments.filter(({ tree, one }) => tree === first.tree && !isCut(one));
      return replace(
        node,
        chosen ? facts(hitFacts(chosen)) : empty('Choose the tool Bench and click a beam, or a row below.'),
        table({
          caption: say('Hits of {beam}, ray {number}, {wavelength} nm', {
            beam: first.beam,
            number: first.ray.number + 1,
            wavelength: digits(first.ray.lambda_nm, 5),
          }),
          columns: ['Ray', 'Angles', 'R', 'T', { label: 'Power', numeric: true }],
          rows: hitRows(sameRay.slice(0, 200)),
          onrow: (row, _, line) => row.addEventListener('click', () => choose(sameRay[line])),
        }),
      );
    },
  };
}

function createRuler(lab) {
  const result = element('div', { 'aria-live': 'polite' });
  const on = checkbox('Measure: clicks in the image set points', false, (checked) => {
    bench.measuring = checked;
    if (checked) lab.view.use('bench');
    handles.draw();
  });
  const clear = button('Clear points', () => {
    bench.points = [];
    changed();
  });
  return {
    node: element('div', { class: 'bench-ruler' }, on.node, clear, result),
    show() {
      clear.disabled = !bench.points.length;
      replace(
        result,
        bench.points.length
          ? facts(measure(bench.points))
          : element('p', { class: 'hint', text: 'Two points give a distance, three the angle at the second.' }),
      );
    },
  };
}

function create(root, lab) {
  const parts = [createBeams(lab), createNumbers(), createRuler(lab)];
  const screen = createBenchScreen(lab, bench, changed);
  const fan = createBenchFan(lab, bench, changed);
  const theory = createBenchTheory(lab);
  root.append(
    parts[0].node,
    group('Segments and hits', { id: 'bench.hits' }, parts[1].node),
    group('Ruler and protractor', { id: 'bench.ruler' }, parts[2].node),
    group('Screen', { id: 'bench.screen', open: false }, screen.node),
    group('Fan of rays', { id: 'bench.fan', open: false, hint: 'caustic and focus' }, fan.node),
    group('Optics and theory', { id: 'bench.theory', open: false, hint: 'measured next to closed forms' }, theory.node),
  );
  const show = () => {
    for (const part of parts) part.show();
  };
  listeners.add(show);
  lab.on('scene', show);
  show();
}

export const panel = { id: 'bench', title: 'Bench', css: 'bench/panel_bench.css', start, create };
