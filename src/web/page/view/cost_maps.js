/* Maps of what each pixel of the final image costs, and of the light that it lacks because rays were cut, drawn over
 * the image, with a legend in units.
 * exports: createCostMaps(lab) -> {node} */

import { say, translated } from '../shared/language.js';
import { showImage } from '../shared/images.js';
import { saveReply } from '../shared/save_file.js';
import { button, choice, count, digits, element, facts, group, notice, replace, seconds, svg } from '../shared/ui.js';

const TITLES = { rays: 'Rays per pixel', time: 'Time per pixel', cut: 'Cut light per pixel' };
const UNITS = { rays: 'rays per pixel', time: 'ns per pixel', cut: 'fraction of cut light per pixel' };

const ABOUT = {
  rays: () => 'Camera, reflected, refracted and shadow rays of each pixel; the same on every machine.',
  time: ({ threads, wall_s: wall }, place) =>
    say(
      'Measured once {place}, in one frame of {time} with {n} threads: another measurement differs. ' +
        'Time is measured for batches of rays, and divided among the rays of a batch.',
      { place: translated(place), time: seconds(wall), n: threads },
    ),
  cut: () =>
    "The fraction of each pixel's light, by weight, that is missing because render.depth or render.min_weight cut " +
    'rays; the same on every machine. The error of a pixel is at most this fraction of the brightest light that was ' +
    'cut.',
};

const valueOf = {
  rays: (value) => say('{n} rays', { n: digits(value) }),
  time: (value) => `${digits(value)} ns`,
  cut: (value) => `${digits(100 * value, 3)} %`,
};

const sumOf = {
  rays: (total) => say('{n} rays', { n: count(total) }),
  time: (total) => say('{time} of all threads', { time: seconds(total / 1e9) }),
};

function legend(answer, which, place) {
  const { end, cut, largest, total } = answer[which];
  const { width, height, colors } = answer;
  const ticks = [0, 0.25, 0.5, 0.75, 1].map((fraction) =>
    element('span', { text: `${fraction === 1 && cut ? '≥ ' : ''}${digits(fraction * end, 3)}` }),
  );
  return [
    element('div', {
      class: 'cost-bar',
      role: 'img',
      'aria-label': cut
        ? say('Colours from 0, dark, to at least {value}, yellow', { value: valueOf[which](end) })
        : say('Colours from 0, dark, to {value}, yellow', { value: valueOf[which](end) }),
      style: { background: `linear-gradient(to right, ${colors.join(', ')})` },
    }),
    element('div', { class: 'cost-ticks', 'aria-hidden': 'true' }, ticks),
    element('p', { class: 'cost-unit', text: UNITS[which] }),
    facts([
      ['Mean', valueOf[which](total / (width * height))],
      ['Largest', valueOf[which](largest)],
      ...(sumOf[which] ? [['Sum', sumOf[which](total)]] : []),
    ]),
    element('p', { class: 'hint', text: ABOUT[which](answer, place) }),
  ];
}

export function createCostMaps(lab) {
  const { view } = lab;
  const image = svg('image', { preserveAspectRatio: 'none' });
  const window = svg('svg', { preserveAspectRatio: 'none' }, image); /* without the key below the map */
  const below = element('div', { class: 'cost-legend', 'aria-live': 'polite' });
  const how = choice({
    label: 'Show',
    radios: true,
    value: 'none',
    choices: [
      ['none', 'Image'],
      ['rays', 'Rays'],
      ['time', 'Time'],
      ['cut', 'Cut light'],
    ],
    onchange: update,
  });
  const node = group(
    'Cost of each pixel',
    { id: 'compare-cost', hint: 'one more frame of this image' },
    how.node,
    below,
  );
  const layer = view.layer('cost');
  let answer = null; /* of the displayed image, or of an earlier one */
  let asking = false;

  layer.append(window);
  layer.parentNode.prepend(layer);
  lab.on('view', draw);
  lab.on('image', update);
  lab.on('restarted', () => {
    answer = null;
    draw();
  });
  return { node };

  function isCurrent() {
    return Boolean(answer) && Boolean(lab.image?.final) && answer.serial === lab.image.serial;
  }

  function update() {
    draw();
    below.classList.toggle('stale', Boolean(answer) && !isCurrent());
    if (how.value === 'none') replace(below);
    else if (isCurrent()) show();
    else if (lab.image?.final) ask();
  }

  async function ask() {
    if (asking) return;
    asking = true;
    if (!answer) replace(below, element('p', { class: 'hint', text: 'Rendering the map …' }));
    try {
      answer = await lab.get('/api/maps');
      asking = false;
      update();
    } catch (error) {
      /* After a change the next final image asks again. */
      if (error.status !== 409 || lab.image?.final)
        replace(below, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
    asking = false;
  }

  function show() {
    const place = lab.engine.kind === 'server' ? 'on this machine' : 'in this browser';
    replace(below, legend(answer, how.value, place), element('div', { class: 'buttons' }, save(how.value)));
    draw();
  }

  /* Saves the map with the key below it, like the file of `cuvette render --rays`, `--time` or `--cut`. */
  function save(which) {
    const act = () => saveReply(lab, `/api/maps/${which}.png`, `${lab.name()}-${which}.png`);
    return button('Save this map', act, { icon: 'download', small: true });
  }

  /* The map of an earlier image would hide the newest one. */
  function draw() {
    const on = how.value !== 'none' && isCurrent();
    layer.style.display = on ? '' : 'none';
    view.note('cost', on ? TITLES[how.value] : null, () => {
      how.set('none');
      update();
      view.stage.focus();
    });
    if (!on) return;
    const { width, height, image: place } = answer;
    showImage(lab, image, `/api/maps/${how.value}.png?of=${answer.serial}`);
    image.setAttribute('width', place.width);
    image.setAttribute('height', place.height);
    image.style.imageRendering = view.scale * devicePixelRatio < 2 ? 'auto' : 'pixelated';
    window.setAttribute('viewBox', `${place.left} 0 ${width} ${height}`);
    window.setAttribute('width', view.width);
    window.setAttribute('height', view.height);
  }
}
