/* The dialog Save video: shows frame after frame of a parameter that changes, of a camera that orbits or of the slime
 * that moves, and records them in the browser. The scene and the view are then as before. Its fields keep their values
 * until the page is closed.
 * exports: saveVideo(lab) */

import { numberInput, numberOf } from '../shared/controls.js';
import { say, translated } from '../shared/language.js';
import { recordings } from '../shared/recorder.js';
import {
  button,
  checkbox,
  choice,
  count,
  dialog,
  download,
  element,
  field,
  memory,
  notice,
  replace,
  seconds,
} from '../shared/ui.js';
import { createParamPicker } from './param_picker.js';
import { filmed } from './video_film.js';
import { slimes, videoFrames } from './video_frames.js';

const FRAMES_MAX = 1000;
const remembered = {
  what: 'sweep',
  parameter: '',
  from: '',
  to: '',
  degrees: '360',
  duration: '4',
  frames: '50',
  fps: '25',
  format: 'WebM',
};

export function saveVideo(lab) {
  const formats = recordings();
  if (formats.length) createForm(lab, formats);
  else
    dialog({
      title: 'Save video',
      content: notice('This browser records no videos.', { remedy: 'use a newer Chromium, Firefox or Safari' }),
    });
}

function createForm(lab, formats) {
  const picker = createParamPicker(lab, { label: 'Parameter', onchoose: chosen });
  const numbers = {
    from: numberInput({ value: remembered.from }),
    to: numberInput({ value: remembered.to }),
    degrees: numberInput({ value: remembered.degrees, min: -3600, max: 3600 }),
    duration: numberInput({ value: remembered.duration, min: 0 }),
    frames: numberInput({ value: remembered.frames, min: 2, max: FRAMES_MAX, step: 1 }),
    fps: numberInput({ value: remembered.fps, min: 1, max: 240, step: 1 }),
  };
  const kinds = [
    ['sweep', 'A parameter'],
    ['orbit', 'The camera orbits'],
    ...(slimes(lab).length ? [['motion', 'The slime moves']] : []),
  ];
  const what = choice({
    label: 'What changes',
    radios: true,
    value: kinds.some(([kind]) => kind === remembered.what) ? remembered.what : 'sweep',
    choices: kinds,
    onchange: show,
  });
  const format = choice({
    label: 'Format',
    radios: true,
    value: formats.some(({ name }) => name === remembered.format) ? remembered.format : formats[0].name,
    choices: formats.map(({ name }) => [name, name]),
    onchange: show,
  });
  const over = checkbox('With rays, angles and ruler', memory.get('image.over', true), (on) =>
    memory.set('image.over', on),
  );
  const about = element('p', { class: 'hint' });
  const parts = {
    sweep: element(
      'div',
      { class: 'video-part' },
      picker.node,
      about,
      field('From', numbers.from),
      field('To', numbers.to),
    ),
    orbit: field('Angle', numbers.degrees, { unit: '°', hint: 'about the pivot, to the right' }),
    motion: field('Duration', numbers.duration, { unit: 's', hint: 'from rest, with its hand script' }),
  };
  const frames = field('Frames', numbers.frames);
  const length = element('p', { class: 'hint video-length' });
  const exact = element('p', { class: 'hint', text: 'The times of the frames are those of a clock, not exact.' });
  const trouble = element('div');
  const bar = element('progress', { max: 1, value: '0', 'aria-label': 'frames done' });
  const words = element('p', { class: 'hint', role: 'status' });
  const result = element('div', { class: 'video-part' });
  const record = button('Record', act, { icon: 'play', kind: 'primary' });
  const stop = button('Stop', () => running?.abort(), { icon: 'stop' });
  const shown = dialog({
    title: 'Save video',
    content: element(
      'div',
      { class: 'video-form' },
      what.node,
      Object.values(parts),
      frames,
      field('Rate', numbers.fps, { unit: 'frames/s' }),
      format.node,
      exact,
      over.node,
      length,
      trouble,
      element('div', { class: 'buttons' }, record, stop),
      bar,
      words,
      result,
    ),
  });
  let running = null; /* an AbortController */
  let address = null;
  const end = lab.on('image', show);
  shown.closed.then(() => {
    end();
    running?.abort();
    if (address) URL.revokeObjectURL(address);
    keep();
  });
  picker.input.value = remembered.parameter;
  for (const input of Object.values(numbers)) input.addEventListener('input', show);
  chosen(picker.row);
  progress();

  function keep() {
    Object.assign(remembered, { what: what.value, parameter: picker.input.value, format: format.value });
    for (const [name, input] of Object.entries(numbers)) remembered[name] = input.value;
  }

  function chosen(row) {
    const range = row && [row.range, translated(row.unit)].filter(Boolean).join(', ');
    about.textContent = row
      ? say('{meaning}; {range}; now {value}', { meaning: translated(row.meaning), range, value: row.value })
      : '';
    if (row && typeof row.value === 'number' && numbers.from.value === '') numbers.from.value = String(row.value);
    show();
  }

  function framesWanted() {
    if (what.value !== 'motion') return numberOf(numbers.frames);
    return Math.max(1, Math.round(numberOf(numbers.duration) * numberOf(numbers.fps)));
  }

  /* The time is extrapolated from the current image: frames differ. */
  function show() {
    if (running) return;
    for (const [kind, node] of Object.entries(parts)) node.hidden = kind !== what.value;
    frames.hidden = what.value === 'motion';
    exact.hidden = chosenFormat().exact;
    const [n, fps] = [framesWanted(), numberOf(numbers.fps)];
    const one = lab.image?.final ? lab.image.wall_s : NaN;
    length.textContent = !(n / fps > 0)
      ? ''
      : Number.isFinite(n * one)
        ? say('{n} frames, {length} long; about {time} if each takes as long as the current image', {
            n: count(n),
            length: seconds(n / fps),
            time: seconds(n * one),
          })
        : say('{n} frames, {length} long', { n: count(n), length: seconds(n / fps) });
  }

  function chosenFormat() {
    return formats.find(({ name }) => name === format.value);
  }

  /* What to record, or null with the first wrong field focused. */
  function request() {
    const fps = numberOf(numbers.fps);
    const needed = { sweep: ['from', 'to', 'frames'], orbit: ['degrees', 'frames'], motion: ['duration'] }[what.value];
    if (what.value === 'sweep' && typeof picker.row?.value !== 'number')
      return wrong(say('Choose a parameter of the scene whose value is a number.'), picker.input);
    for (const name of [...needed, 'fps'])
      if (!Number.isFinite(numberOf(numbers[name]))) return wrong(say('Enter a number.'), numbers[name]);
    if (!(fps >= 1 && fps <= 240)) return wrong(say('Enter 1 to 240 frames per second.'), numbers.fps);
    const n = framesWanted();
    if (!(Number.isInteger(n) && n >= 2 && n <= FRAMES_MAX))
      return wrong(say('A video has 2 to {most} frames.', { most: FRAMES_MAX }), numbers[needed.at(-1)]);
    return {
      kind: what.value,
      row: picker.row,
      from: numberOf(numbers.from),
      to: numberOf(numbers.to),
      degrees: numberOf(numbers.degrees),
      count: n,
      fps,
    };
  }

  function wrong(text, input) {
    replace(trouble, notice(text, { kind: 'error' }));
    input.focus();
    return null;
  }

  async function act() {
    const wanted = request();
    if (!wanted) return;
    keep();
    replace(trouble);
    replace(result);
    running = new AbortController();
    const began = performance.now();
    progress({ done: 0, of: wanted.count });
    try {
      const file = await filmed(lab, videoFrames(lab, wanted), chosenFormat(), {
        fps: wanted.fps,
        over: over.value,
        signal: running.signal,
        progress: (done) => progress({ done, of: wanted.count, began }),
      });
      running = null;
      progress();
      if (file) finished(file, wanted.count, (performance.now() - began) / 1000);
      else words.textContent = say('Stopped.');
    } catch (error) {
      running = null;
      progress();
      replace(trouble, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
  }

  function progress(now = null) {
    record.disabled = Boolean(now);
    stop.hidden = bar.hidden = !now;
    bar.value = now ? now.done / now.of : 0;
    if (!now) words.textContent = '';
    else if (!now.done) words.textContent = say('{done} of {of} frames', now);
    else {
      const left = ((performance.now() - now.began) / 1000 / now.done) * (now.of - now.done);
      words.textContent = say('{done} of {of} frames, about {left} left', {
        ...now,
        left: seconds(Math.max(1, Math.round(left))),
      });
    }
  }

  function finished(file, frames, taken) {
    const name = `${lab.name()}.${chosenFormat().ending}`;
    if (address) URL.revokeObjectURL(address);
    address = URL.createObjectURL(file);
    words.textContent = say('{frames} frames in {time}; {size}B', {
      frames: count(frames),
      time: seconds(taken),
      size: count(file.size),
    });
    replace(
      result,
      element('video', { controls: true, loop: true, src: address, 'aria-label': 'The video' }),
      button('Save file', () => download(file, name), { icon: 'download', kind: 'primary' }),
    );
    result.scrollIntoView({ block: 'nearest' });
  }
}
