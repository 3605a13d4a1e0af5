/* The panel Lens: the report on the lens of the scene, as `cuvette lens report`; renewed after a change of the scene
 * while it is shown. exports: panel */

import { say } from '../shared/language.js';
import { saveReply } from '../shared/save_file.js';
import { LENS_FILES, openFile, openLens } from '../shared/share.js';
import { button, checkbox, choice, digits, element, empty, notice, replace, text } from '../shared/ui.js';
import { lensGroups, wavelengths } from './lens_figures.js';

const REST_MS = 500; /* without a change, before the report is renewed */

/* experiments/lenses, without comments: tests/web/lens.test.mjs compares them. */
const EXAMPLES = {
  'cemented-achromat.csv': `title,Cemented achromat f/6
unit_mm,25.4
f_number,6
field_deg,0,3.5,5
wavelength_nm,587.5618,486.1327,656.2725
radius,thickness,medium,conic,stop
12.38401,0.434,1.5725/57.55,0,1
-7.9414,0.321,1.64769/33.85,0,
-48.44396,19.6059,air,0,
`,
  'cooke-triplet.csv': `title,Cooke triplet f/5
unit_mm,1
pupil,10
field_deg,0,14,20
wavelength_nm,550,480,650
radius,thickness,medium,conic,stop
22.01359,3.25896,1.620409/60.2809,0,
-435.76044,6.00755,air,0,
-22.21328,0.99997,1.62004/36.37,0,
20.29192,4.75041,air,0,1
79.6836,2.95208,1.620409/60.2809,0,
-18.39533,42.20778,air,0,
`,
};

const state = { report: null, error: null, made: '', asked: '', system: '', fields: '', waves: '', nm: 0, auto: true };
let lens = null; /* {check(), stop()} of the panel, once it exists */

/* What a report depends on: the question, and the scene, but for moves of the camera. */
const statusOf = (lab) => JSON.stringify([state.system, state.fields, state.waves, lab.scene?.version]);

/* The systems of the scene: the names of its lenses without their numbers. */
const systemsOf = (lab) =>
  [
    ...new Set(
      (lab.scene?.objects ?? [])
        .filter(({ name, kind, shape }) => kind === 'solid' && shape === 'lens' && !lab.param(`${name}.follows`)?.value)
        .map(({ name }) => name.replace(/-\d+$/, '')),
    ),
  ].sort();

function query() {
  const list = (words) =>
    words
      .split(/[;,\s]+/)
      .filter(Boolean)
      .join();
  const parts = Object.entries({ system: state.system, field: list(state.fields), wavelength: list(state.waves) });
  const words = parts.filter(([, value]) => value).map(([name, value]) => `${name}=${encodeURIComponent(value)}`);
  return words.length ? `?${words.join('&')}` : '';
}

/* What opens a lens, for scenes without one. */
function starters(lab) {
  const input = element('input', { type: 'file', accept: LENS_FILES, hidden: true });
  input.addEventListener('change', () => {
    if (input.files[0]) openFile(lab, input.files[0]);
  });
  const example = (file) => {
    const label = file.replace('.csv', '').replaceAll('-', ' ');
    return button(label[0].toUpperCase() + label.slice(1), () => openLens(lab, file, EXAMPLES[file]), {
      icon: 'plus',
      translate: 'no',
    });
  };
  return element(
    'div',
    { class: 'lens-start' },
    empty('A report needs lenses: solids of shape lens on one axis, or a lens file of Zemax, pbrt or a table.'),
    element(
      'div',
      { class: 'buttons', role: 'group', 'aria-label': 'Open a lens' },
      Object.keys(EXAMPLES).map(example),
      button('Lens file …', () => input.click(), {
        icon: 'folder',
        title: say('A file that ends in {endings}', { endings: LENS_FILES }),
      }),
    ),
    input,
  );
}

function createControls(lab, renew, draw) {
  const node = element('div', { class: 'lens-controls' });
  const again = button('Renew', renew, { icon: 'refresh' });
  const auto = checkbox('after each change', true, (on) => {
    state.auto = on;
    lens.check();
  });
  const list = (label, placeholder, key) =>
    text({
      label,
      value: '',
      placeholder,
      onchange: (value) => {
        state[key] = value;
        renew();
      },
    });
  const save = (ending) =>
    button(
      say('Save {format}', { format: ending.toUpperCase() }),
      () => saveReply(lab, `/api/lens${ending === 'csv' ? '.csv' : ''}${query()}`, `${lab.name()}-lens.${ending}`),
      { icon: 'download', small: true },
    );
  const systems = element('div', { class: 'lens-choice' });
  const waves = element('div', { class: 'lens-choice' });
  let shown = '';
  node.append(
    element('div', { class: 'buttons' }, again, auto.node),
    systems,
    list('Fields', 'of the beams', 'fields').node,
    list('Wavelengths, nm', 'of the beams', 'waves').node,
    waves,
    element('div', { class: 'buttons' }, save('csv'), save('json')),
  );
  return { node, show };

  function show() {
    const names = systemsOf(lab);
    const all = state.report ? wavelengths(state.report) : [];
    if (!names.includes(state.system)) state.system = '';
    if (!all.includes(state.nm)) state.nm = 0;
    const now = JSON.stringify([names, all, state.system, state.nm]);
    if (now === shown) return;
    shown = now;
    replace(
      systems,
      names.length > 1
        ? choice({
            label: 'System',
            choices: [['', 'all lenses'], ...names.map((name) => [name, name])],
            value: state.system,
            onchange: (value) => {
              state.system = value;
              renew();
            },
          }).node
        : null,
    );
    replace(
      waves,
      all.length > 1
        ? choice({
            label: 'Show',
            choices: [['0', 'all wavelengths'], ...all.map((nm) => [String(nm), `${digits(nm, 7)} nm`])],
            value: String(state.nm),
            onchange: (value) => {
              state.nm = Number(value);
              draw();
            },
          }).node
        : null,
    );
  }
}

function create(root, lab) {
  let timer = 0;
  let asking = false;
  let shown = false;
  const controls = createControls(lab, renew, draw);
  const age = element('p', { class: 'lens-age', role: 'status' });
  const place = element('div', { class: 'lens-report' });
  root.append(controls.node, age, place);
  lab.on('scene', check);
  lens = {
    check,
    visible(on) {
      shown = on;
      check();
    },
  };

  function draw() {
    controls.show();
    if (!systemsOf(lab).length) replace(place, starters(lab));
    else if (state.error) replace(place, notice(state.error.message, { kind: 'warning', remedy: state.error.remedy }));
    else if (state.report) replace(place, lensGroups(state.report, state.nm));
    controls.node.hidden = !systemsOf(lab).length;
    mark();
  }

  /* Says whether the report is that of the scene. */
  function mark() {
    const old = state.made !== statusOf(lab);
    const words = asking ? 'Tracing …' : old && state.made ? 'From an earlier state of the scene: renew it.' : '';
    if (age.textContent !== words) age.textContent = words;
    age.hidden = !words;
    place.classList.toggle('stale', old && Boolean(state.report));
    place.setAttribute('aria-busy', String(asking));
  }

  /* After a change, when there are no more for a while. */
  function check() {
    clearTimeout(timer);
    if (!shown || !lab.scene) return;
    controls.show();
    mark();
    const now = statusOf(lab);
    if (!asking && now !== state.asked && (state.auto || !state.made)) timer = setTimeout(renew, REST_MS);
  }

  async function renew() {
    clearTimeout(timer);
    if (asking) return;
    asking = true;
    const asked = statusOf(lab);
    state.asked = asked;
    mark();
    try {
      state.report = systemsOf(lab).length ? await lab.get(`/api/lens${query()}`) : null;
      state.error = null;
    } catch (error) {
      state.report = null;
      state.error = error;
    }
    state.made = asked;
    asking = false;
    draw();
    check();
  }
}

export const panel = {
  id: 'lens',
  title: 'Lens',
  wide: true,
  css: 'bench/panel_lens.css',
  create,
  shown: () => lens?.visible(true),
  hidden: () => lens?.visible(false),
};
