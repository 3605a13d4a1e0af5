/* The panel Pixel: explains the colour of a pixel by its ray tree, as a table, over the image, and in a side and a
 * top view.
 * exports: panel. The tool Inspect selects the pixel: click, drag or arrow keys; Escape clears. */

import { say } from '../shared/language.js';
import { isDark } from '../shared/display.js';
import { showImage } from '../shared/images.js';
import { depthNote } from '../shared/notes.js';
import { saveReply } from '../shared/save_file.js';
import {
  button,
  count,
  dialog,
  digits,
  element,
  empty,
  facts,
  group,
  notice,
  number,
  replace,
  svg,
} from '../shared/ui.js';
import { solidPoints } from '../view/solids.js';
import { createQuestion } from './pixel_question.js';
import { createRayOverlay } from './ray_overlay.js';
import { createRayPlot, sidePlane, topPlane } from './ray_plot.js';
import { createRayTable } from './ray_table.js';
import { isCut, kinds } from './ray_tree.js';

let question = null;
let overlay = null;
const marking = new Set(); /* all displays of the marked ray */

function mark(ray) {
  for (const shows of marking) shows(ray);
}

function start(lab) {
  let before = null; /* the pixel before a drag */
  question = createQuestion(lab);
  overlay = createRayOverlay(lab);
  marking.add(overlay.mark);
  question.on(() => overlay.show(question.tree, question.pixel));
  question.on(() => note(lab));
  lab.on('tool', () => note(lab));
  lab.on('view', () => overlay.draw());
  lab.on('state', () => {
    if (question.tree) overlay.draw();
  });
  lab.view.tool('ask', {
    label: 'Inspect',
    icon: 'pixel',
    order: 40,
    cursor: 'crosshair',
    hint: 'See where the light of a pixel comes from: click it (arrow keys: the next pixel)',
    chosen: () => lab.panels?.select('pixel'),
    down: (point) => {
      before = question.pixel;
      if (point.inside) question.ask(point.x, point.y);
      return point.inside;
    },
    cancel: () => (before ? question.ask(before.x, before.y) : question.clear()),
    move: (point) => question.ask(point.x, point.y),
    hover: (point) => mark(overlay.nearest(point)),
    leave: () => mark(null),
    key: (event) => pressed(event.key, event.shiftKey ? 10 : 1),
  });
}

/* Names the pixel over the image, with a button that clears the rays, while another tool is active or the rays belong
 * to an earlier view. */
function note(lab) {
  const { pixel } = question;
  const which =
    pixel &&
    (question.moved ? say('Rays of pixel {x}, {y} of an earlier view', pixel) : say('Rays of pixel {x}, {y}', pixel));
  lab.view.note('pixel', pixel && (lab.view.chosen !== 'ask' || question.moved) ? which : null, () => {
    question.clear();
    lab.view.stage.focus();
  });
}

function pressed(key, far) {
  const steps = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] };
  if (key === 'Escape' && question.pixel) question.clear();
  else if (steps[key] && question.pixel) question.step(...steps[key]);
  else return false;
  return true;
}

/* --- the panel --- */

function chooser(lab) {
  const go = () => question.ask(x.value || 0, y.value || 0);
  const x = number({ label: 'Pixel x', min: 0, step: 1, onchange: go });
  const y = number({ label: 'y', min: 0, step: 1, onchange: go });
  const again = button('Trace again', () => question.again(), {
    icon: 'refresh',
    small: true,
    title: 'Trace the rays of this pixel for the current camera and scene',
  });
  const clear = button('Clear', () => question.clear(), { kind: 'quiet', small: true, title: 'Clear (Escape)' });
  const tool = button(
    'Select in the image',
    () => {
      lab.view.use('ask');
      lab.view.stage.focus();
    },
    { icon: 'pixel', small: true },
  );
  return {
    node: element('div', { class: 'pixel-chooser' }, x.node, y.node, tool, again, clear),
    show() {
      x.input.max = Math.max(0, lab.view.width - 1);
      y.input.max = Math.max(0, lab.view.height - 1);
      x.set(question.pixel ? question.pixel.x : NaN);
      y.set(question.pixel ? question.pixel.y : NaN);
      clear.disabled = !question.pixel;
      again.hidden = !question.moved && !question.old;
    },
  };
}

/* The number of rays of each kind, and of rays cut off by depth or weight. */
function parts(tree) {
  const words = {
    camera: say('from the camera'),
    reflect: say('reflected'),
    refract: say('refracted'),
    shadow: say('to lights'),
  };
  const traced = tree.rays.filter((ray) => !isCut(ray));
  const list = Object.keys(words).map((kind) => [traced.filter((ray) => ray.node.kind === kind).length, words[kind]]);
  list.push([tree.rays.length - traced.length, say('cut off')]);
  return list
    .filter(([n]) => n)
    .map(([n, what]) => `${count(n)} ${what}`)
    .join(', ');
}

function summary(tree) {
  const { radiance, displayed, lambda_nm: lambda, depth } = tree.answer;
  const [r, g, b] = displayed;
  const deepest = tree.rays.reduce((most, ray) => (isCut(ray) ? most : Math.max(most, ray.node.depth)), 0);
  const tinted = element(
    'span',
    { class: 'pixel-colour' },
    element('span', { class: 'swatch', style: { background: `rgb(${r} ${g} ${b})` }, 'aria-hidden': 'true' }),
    `${r} ${g} ${b}`,
  );
  return facts([
    ['Radiance', radiance.map((x) => digits(x)).join(' · ')],
    ['Displayed as', tinted],
    ['Rays', `${count(tree.rays.length)}: ${parts(tree)}`],
    ['Deepest level', say('{deepest} (limit {depth})', { deepest, depth })],
    ['Refractive indices at', `${digits(lambda)} nm`],
  ]);
}

/* The table shows a Whitted ray tree, whose sum is not the pixel's value for other rendering methods. */
function integratorNote(lab) {
  const how = lab.param('render.integrator')?.value;
  if (how === 'path')
    return (
      'The image is path traced: this tree has all branches instead, and no light from ' + 'diffuse interreflection.'
    );
  if (how === 'zbuffer')
    return 'The image is rasterised with a depth buffer: this is the tree that ray tracing would give.';
  if (how && how !== 'whitted' && how !== 'raycast')
    return 'The image shows no lighting: this is the tree that ray tracing would give.';
  if (lab.param('render.spectrum')?.value === 'spectral')
    return 'The image is spectral: this is the tree of one wavelength.';
  return null;
}

function cutOff(lab, tree) {
  const cut = depthNote(tree, lab);
  if (!cut) return null;
  const raise = () => lab.set(cut.values).catch(lab.fail);
  return [
    notice(cut.text, { kind: 'warning' }),
    element('div', { class: 'buttons' }, button(cut.label, raise, { small: true })),
  ];
}

function legend() {
  return element(
    'ul',
    { class: 'ray-legend', 'aria-label': 'Legend' },
    kinds.map(([line, words]) =>
      element(
        'li',
        {},
        svg(
          'svg',
          { class: 'ray-sample', viewBox: '0 0 36 10', 'aria-hidden': 'true' },
          svg('line', { class: `ray ${line}`, x1: 1, y1: 5, x2: 35, y2: 5, 'stroke-width': 2.5 }),
        ),
        words,
      ),
    ),
  );
}

function openDrawing(lab, { x, y }) {
  const address = `/api/trace.svg?x=${x}&y=${y}`;
  const title = say('Pixel {x}, {y}: rays in the plane of incidence and from above', { x, y });
  const image = element('img', { alt: title });
  showImage(lab, image, address);
  const content = element(
    'div',
    { class: isDark() ? 'trace-drawing dark' : 'trace-drawing' },
    image,
    button('Save drawing', () => saveReply(lab, address, `pixel-${x}-${y}.svg`), { icon: 'download', small: true }),
  );
  dialog({ title, wide: true, content });
}

function createAnswer(lab) {
  const table = createRayTable({ caption: 'Rays of the pixel', onmark: mark });
  const side = createRayPlot({ title: 'From the side', onmark: mark, onchoose: table.reveal });
  const top = createRayPlot({ title: 'From above', onmark: mark, onchoose: table.reveal });
  const head = element('div', { class: 'pixel-summary' });
  const omitted = element('p', { class: 'hint' });
  marking.add(table.mark).add(side.mark).add(top.mark);
  const node = element(
    'div',
    { class: 'pixel-answer', hidden: true },
    head,
    legend(),
    omitted,
    element('div', { class: 'ray-figures' }, side.node, top.node),
    button('Larger drawing', () => openDrawing(lab, question.tree.pixel), { icon: 'enlarge', small: true }),
    group(
      'Rays',
      { id: 'pixel-rays' },
      element(
        'div',
        { class: 'ray-buttons' },
        button('Open all', table.openAll, { kind: 'quiet', small: true }),
        button('Close all', table.closeAll, { kind: 'quiet', small: true }),
      ),
      table.node,
    ),
  );
  let shown = null;

  function plot(tree) {
    const solids = tree ? solidPoints(lab) : [];
    side.show(tree, sidePlane(lab.state?.camera), solids);
    top.show(tree, topPlane(), solids);
  }

  return {
    node,
    show(tree) {
      node.hidden = !tree;
      if (tree === shown) return;
      shown = tree;
      table.show(tree);
      plot(tree);
      lab.want('pixel', solidsOf(tree)).then(() => tree === shown && lab.scene?.whole === false && plot(tree));
      if (!tree) return;
      const note = integratorNote(lab);
      replace(head, summary(tree), note ? notice(note) : cutOff(lab, tree));
      omitted.textContent = overlay.omitted
        ? say('Rays drawn: {drawn}. Rays of lower weight, in the table only: {omitted}.', {
            drawn: count(overlay.count),
            omitted: count(overlay.omitted),
          })
        : '';
      omitted.hidden = !overlay.omitted;
    },
  };
}

/* The solids that the rays meet. */
const solidsOf = (tree) => [...new Set((tree?.rays || []).map((ray) => ray.node.hit?.solid).filter(Boolean))];

function staleNotice() {
  if (question.old) return notice('The scene and the camera have changed since these rays were traced.');
  return question.moved ? notice('The camera has moved: these rays belong to the earlier view.') : null;
}

function create(root, lab) {
  const choose = chooser(lab);
  const answer = createAnswer(lab);
  const message = element('div', {});
  root.append(choose.node, message, answer.node);
  root.addEventListener('keydown', (event) => {
    if (event.key === 'Escape' && pressed('Escape')) event.preventDefault();
  });
  const show = () => {
    choose.show();
    root.setAttribute('aria-busy', String(question.busy));
    answer.show(question.tree);
    if (question.error)
      replace(message, notice(question.error.message, { kind: 'error', remedy: question.error.remedy }));
    else
      replace(
        message,
        question.pixel
          ? staleNotice()
          : empty('Choose the tool Inspect above the image and click a pixel, or enter its coordinates here.'),
      );
  };
  question.on(show);
  lab.on('view', choose.show);
  show();
}

export const panel = { id: 'pixel', title: 'Pixel', css: 'bench/panel_pixel.css', start, create };
