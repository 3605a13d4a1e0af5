/* The palette of the optical bench in the panel Objects: drawings of lenses, prisms, mirrors and beams. One action puts
 * a thing upright into the plane of the bench, where light passes it; if none does, with light of its own.
 *
 * exports: createPalette(lab, choice) -> node; lab.palette = {add(id) -> promise of true on success} */

import { say } from '../shared/language.js';
import { choice as choiceOf, element, gesture, memory, number } from '../shared/ui.js';
import { add, times } from '../shared/vectors.js';
import { focalLength, lensKinds, lensOfFocus, lensOfRadii } from './lens_maker.js';
import { N, palette } from './palette_items.js';

const GAP = 0.25; /* around a new thing, in sizes */
const BEFORE = 3; /* sizes from the start of light to what it meets, at least, at an angle */
const MARGIN = 0.06; /* of the window */

export function createPalette(lab, choice) {
  const lens = createLensForm(lab);
  lab.palette = { add: (id) => addItem(lab, choice, id, lens) };
  return element(
    'section',
    {
      class: 'palette',
      'aria-label': 'Things for the bench',
      onpointerenter: lens.show /* the window may be another one */,
      onfocusin: lens.show,
    },
    palette.map(([title, items]) =>
      element(
        'div',
        { class: 'palette-group', role: 'group', 'aria-label': title },
        items.map((item) =>
          element(
            'button',
            { type: 'button', class: 'palette-item', title: item.title, onclick: () => lab.palette.add(item.id) },
            item.icon(),
            element('span', { text: item.name }),
          ),
        ),
      ),
    ),
    lens.node,
  );
}

/* --- the form of the next lens: its kind and its focal length or its radii --- */

const unitName = (lab) => {
  const metres = lab.param('render.unit_m')?.value;
  return [
    ['m', 1],
    ['dm', 0.1],
    ['cm', 0.01],
    ['mm', 0.001],
  ].find(([, size]) => Math.abs(metres / size - 1) < 1e-9)?.[0];
};

const round = (x) => Number(x.toPrecision(6));

/* Until a person enters a length, it follows the size of what is shown. */
function createLensForm(lab) {
  let kind = memory.get('palette.lens', 'biconvex');
  let focus = null; /* entered; null: suitable */
  let radii = null; /* entered instead of the focal length */
  const collects = () => lensKinds.find(([word]) => word === kind)[2];
  const kinds = choiceOf({
    label: 'Form of the lens',
    choices: lensKinds.map(([word, label]) => [word, label]),
    value: kind,
    onchange: (word) => {
      kind = word;
      memory.set('palette.lens', word);
      radii = null;
      if (focus !== null) focus = Math.abs(focus) * (collects() ? 1 : -1);
      show();
    },
  });
  const field = (label, title, act) => {
    const made = number({ label, value: 0, onchange: act });
    made.node.title = title;
    return made;
  };
  const f = field('f', say('Focal length, below 0 for a lens that spreads light'), (value) => {
    if (value === 0) return show();
    focus = value;
    radii = null;
    if (value > 0 !== collects()) kind = value > 0 ? 'biconvex' : 'biconcave';
    return show();
  });
  const entered = (at) => (value) => {
    radii = [radii1.value, radii2.value];
    radii[at] = value;
    show();
  };
  const radii1 = field(
    'R₁',
    say('Radius of the side where the light comes: above 0 if its centre is where the light goes, 0 if flat'),
    entered(0),
  );
  const radii2 = field(
    'R₂',
    say('Radius of the side where the light goes: above 0 if its centre is there too, 0 if flat'),
    entered(1),
  );
  const unit = element('span', { class: 'hint' });
  const node = element(
    'div',
    { class: 'palette-lens', role: 'group', 'aria-label': 'The next lens' },
    kinds.node,
    f.node,
    radii1.node,
    radii2.node,
    unit,
  );
  lab.on('scene', show);
  lab.on('section', show);
  show();
  return { node, form, show };

  function form(size) {
    return radii
      ? lensOfRadii(...radii, size)
      : lensOfFocus(kind, focus ?? 2 * size * (collects() ? 1 : -1), N.bk7, size);
  }

  function show() {
    kinds.set(kind);
    const made = form(usualSize(lab));
    const focal = focalLength(made, N.bk7);
    f.set(Number.isFinite(focal) ? round(focal) : 0); /* 0: without power */
    radii1.set(round(made.radius_1));
    radii2.set(round(made.radius_2));
    const name = unitName(lab);
    unit.textContent = name
      ? say('in {unit}, of glass with n = 1.5172', { unit: name })
      : say('in scene units, of glass with n = 1.5172');
  }
}

const usualSize = (lab) => lab.section?.size?.() || 1;

/* --- adding --- */

/* A thing's frame: its axes x, y, z in the world; turned in the plane from right to up. */
function frameOf({ right, up, normal }, part) {
  const angle = ((part.lies ?? part.stands) * Math.PI) / 180;
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const along = add(times(right, cos), times(up, sin));
  const across = add(times(right, -sin), times(up, cos));
  return part.lies === undefined ? [along, times(normal, -1), across] : [normal, along, across];
}

/* As angles about the world's x, y, z in this order. */
function anglesOf([x, y, z]) {
  const steep = Math.abs(x[2]) > 1 - 1e-9;
  const radians = steep
    ? [Math.atan2(-Math.sign(x[2]) * y[0], y[1]), (-Math.sign(x[2]) * Math.PI) / 2, 0]
    : [Math.atan2(y[2], z[2]), Math.asin(-x[2]), Math.atan2(x[1], x[0])];
  return radians.map((angle) => tidy((angle * 180) / Math.PI));
}

const tidy = (x) => Number(x.toFixed(9)) + 0;
const tidied = (point) => point.map((x) => Number(x.toPrecision(12)) + 0);

function nameFor(lab, base, taken) {
  for (let k = 1; ; k++) {
    const name = k === 1 ? base : `${base}${k}`;
    if (!lab.object(name) && !taken.has(name)) return name;
  }
}

/* The newest scene: what was just added takes its place. */
function newest(lab) {
  const here = () => lab.change.idle() && lab.scene?.generation >= lab.newestGeneration;
  return new Promise((resolve) => {
    if (here()) return resolve();
    const end = lab.on('scene', () => {
      if (!here()) return;
      end();
      resolve();
    });
    return undefined;
  });
}

async function addItem(lab, choice, id, lens) {
  const item = palette.flatMap(([, items]) => items).find((each) => each.id === id);
  try {
    await newest(lab);
    const place = await lab.section.place();
    const made = item.make(place.size, { lens: lens.form(place.size) });
    const at = made.parts.length ? freePlace(place, made) : startOf(place);
    const world = ([u, v], depth = 0) => {
      const { origin, right, up, normal } = place.plane;
      return tidied([origin, times(right, u), times(up, v), times(normal, depth)].reduce(add));
    };
    const taken = new Set();
    const bodies = [];
    for (const part of made.parts) {
      const name = nameFor(lab, part.name, taken);
      taken.add(name);
      const set = part.follows ? { ...part.set, follows: bodies[0].name } : { ...part.set, ...placed(part) };
      bodies.push({ kind: 'solid', shape: part.shape, name, set });
    }
    const lit = made.parts.length && place.lines.some((line) => passes(line, at, made.half));
    const light = { kind: 'beam', name: nameFor(lab, beamName(made.beam), taken), set: lightOf() };
    const all = lit ? bodies : [light, ...bodies];
    return await choice.addAll(all, (bodies[0] || light).name, gesture('palette'));

    function placed(part) {
      const frame = frameOf(place.plane, part);
      const [u, v] = [at[0] + part.at[0], at[1] + part.at[1]];
      return { position: tidied(add(world([u, v]), times(frame[1], -part.from))), rotation: anglesOf(frame) };
    }

    /* From the left edge, or from nearer at an angle. */
    function lightOf() {
      const {
        angle,
        set,
        at: [du, dv],
      } = made.beam;
      const target = [at[0] + du, at[1] + dv];
      const [cos, sin] = [Math.cos((angle * Math.PI) / 180), Math.sin((angle * Math.PI) / 180)];
      const edge = target[0] - (place.window[0] + MARGIN * (place.window[1] - place.window[0]));
      const away = angle || edge < place.size ? (BEFORE * place.size) / 1.2 : edge;
      const start = [target[0] - away * cos, target[1] - away * sin];
      const normal = set.kind === 'sheet' || set.kind === 'fan' ? { normal: tidied(place.plane.normal) } : {};
      return made.parts.length
        ? { ...set, ...normal, position: world(start), target: world(target) }
        : { ...set, ...normal, position: world(at), target: world([at[0] + 2 * place.size, at[1]]) };
    }
  } catch (error) {
    lab.fail(error);
    return false;
  }
}

const beamName = ({ set }) => ({ sheet: 'rays', fan: 'source' })[set.kind] || 'ray';

/* --- places --- */

/* Whether a line runs through the middle of a box. */
function passes([a, b], at, half) {
  const [du, dv] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(du, dv);
  if (!(length > 0)) return false;
  const along = ((at[0] - a[0]) * du + (at[1] - a[1]) * dv) / length;
  const across = Math.abs((at[0] - a[0]) * dv - (at[1] - a[1]) * du) / length;
  return along > 0 && along < length && across < 0.8 * Math.max(...half);
}

/* The start of light without a thing: near the left edge, at the height of the first thing in the window or of its
 * middle, where no other light starts. */
function startOf({ window, size, taken, lines }) {
  const [u0, u1, v0, v1] = window;
  const thing = taken.find(([a, b, c, d]) => a > u0 && b < u1 && c > v0 && d < v1);
  const first = u0 + MARGIN * (u1 - u0);
  const v = thing ? (thing[2] + thing[3]) / 2 : (v0 + v1) / 2;
  const places = [0, 1, 2, 3, 4].flatMap((row) => [0, 1, 2].map((k) => [first + 0.6 * size * k, v - 0.8 * size * row]));
  const used = ([u, at]) => lines.some(([a]) => Math.hypot(a[0] - u, a[1] - at) < 0.45 * size);
  const inThing = ([u, at]) => taken.some(([a, b, c, d]) => u > a - size && u < b && at > c && at < d);
  return tidied(places.find((place) => !used(place) && !inThing(place)) || places[0]);
}

/* In the light that is there, from the middle of the window to the right and then to the left, or above and below. */
function freePlace({ window, size, taken, lines }, { half, last }) {
  const [u0, u1, v0, v1] = window;
  const middle = [(u0 + u1) / 2, (v0 + v1) / 2];
  const gap = GAP * size;
  const free = ([u, v]) =>
    taken.every(
      ([a, b, c, d]) =>
        u + half[0] + gap <= a ||
        u - half[0] - gap >= b ||
        v + half[1] + 0.2 * gap <= c ||
        v - half[1] - 0.2 * gap >= d,
    ) &&
    u - half[0] >= u0 &&
    u + half[0] <= u1 &&
    v - half[1] >= v0 &&
    v + half[1] <= v1;
  const steps = Math.floor((u1 - middle[0]) / (0.5 * size));
  const right = Array.from({ length: steps }, (_, k) => middle[0] + 0.5 * size * k);
  const left = Array.from({ length: steps - 1 }, (_, k) => middle[0] - 0.5 * size * (k + 1));
  const columns = last ? [...[...right].reverse(), ...left] : [...right, ...left];
  const lit = columns.map((u) => [u, heightOf(lines, u, middle[1])]).filter(([, v]) => v !== null);
  const rows = [0, 1, -1, 2, -2].map((k) => middle[1] + k * size);
  const dark = rows.flatMap((v) => columns.map((u) => [u, v]));
  const found = [...lit, ...dark].find(free) || middle;
  return found.map((x) => Number(x.toPrecision(6)));
}

/* The middle of the rays that cross u. */
function heightOf(lines, u, otherwise) {
  const heights = lines
    .filter(([a, b]) => (a[0] - u) * (b[0] - u) < 0)
    .map(([a, b]) => a[1] + ((b[1] - a[1]) * (u - a[0])) / (b[0] - a[0]))
    .sort((a, b) => a - b);
  if (!heights.length) return null;
  const mid = heights[heights.length >> 1];
  return Math.abs(mid - otherwise) < 1e-9 ? otherwise : mid;
}
