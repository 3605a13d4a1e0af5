/* The dialog Save video: renders a parameter that changes from frame to frame, or the moving slime, into one file. The
 * dialog may be closed meanwhile. Its fields keep their values until the page is closed.
 * exports: saveVideo(lab) */

import { needsProgram } from '../shared/commands.js';
import { numberInput, numberOf } from '../shared/controls.js';
import { showImage } from '../shared/images.js';
import { button, choice, count, dialog, download, element, field, notice, replace, seconds } from '../shared/ui.js';
import { createParamPicker } from './param_picker.js';

const FORMATS = [
  ['apng', 'Animated PNG: browsers play it'],
  ['y4m', 'YUV4MPEG2: for video programs, such as ffmpeg'],
];
const ENDINGS = { apng: 'png', y4m: 'y4m' };
const remembered = {
  what: 'sweep',
  parameter: '',
  from: '',
  to: '',
  frames: '50',
  duration: '',
  fps: '25',
  format: 'apng',
};

/* A video takes minutes, and more memory for its frames than a browser has. */
function saveElsewhere(lab) {
  const motion = lab.slime ? [(file) => `cuvette animate ${file} -o video.apng`] : [];
  dialog({
    title: 'Save video',
    content: needsProgram(lab, 'Videos are rendered by the program on a computer, not in a browser.', [
      ...motion,
      (file) => `cuvette lab ${file}`,
    ]),
  });
}

export function saveVideo(lab) {
  if (lab.engine.kind === 'server') createForm(lab);
  else saveElsewhere(lab);
}

function createForm(lab) {
  const picker = createParamPicker(lab, { label: 'Parameter', onchoose: chosen });
  const numbers = {
    from: numberInput({ value: remembered.from }),
    to: numberInput({ value: remembered.to }),
    frames: numberInput({ value: remembered.frames, min: 2, max: 1000, step: 1 }),
    duration: numberInput({ value: remembered.duration, min: 0, placeholder: 'default' }),
    fps: numberInput({ value: remembered.fps, min: 1, max: 240, step: 1 }),
  };
  const what = choice({
    label: 'What changes',
    radios: true,
    value: lab.slime ? remembered.what : 'sweep',
    choices: [
      ['sweep', 'A parameter'],
      ['motion', 'The slime moves'],
    ],
    onchange: show,
  });
  const format = choice({ label: 'Format', choices: FORMATS, value: remembered.format, onchange: show });
  const about = element('p', { class: 'hint' });
  const sweep = element(
    'div',
    { class: 'video-part' },
    picker.node,
    about,
    field('From', numbers.from),
    field('To', numbers.to),
    field('Frames', numbers.frames),
  );
  const motion = element(
    'div',
    { class: 'video-part' },
    field('Duration', numbers.duration, {
      unit: 's',
      hint: 'from rest, with its hand script; default: 2 s more than the script, or 4 s without one',
    }),
  );
  const length = element('p', { class: 'hint video-length' });
  const trouble = element('div');
  const bar = element('progress', { max: 1, value: '0', 'aria-label': 'frames done' });
  const words = element('p', { class: 'hint', role: 'status' });
  const result = element('div', { class: 'video-part' });
  const render = button('Render', act, { icon: 'play', kind: 'primary' });
  const stop = button('Stop', () => lab.post('/api/video/stop', {}).catch(fail), { icon: 'stop' });
  const shown = dialog({
    title: 'Save video',
    content: element(
      'div',
      { class: 'video-form' },
      what.node,
      sweep,
      motion,
      field('Rate', numbers.fps, { unit: 'frames/s' }),
      format.node,
      length,
      trouble,
      element('div', { class: 'buttons' }, render, stop),
      bar,
      words,
      result,
    ),
  });
  const ends = [lab.on('video', progress), lab.on('state', () => progress(lab.state.video)), lab.on('image', show)];
  shown.closed.then(() => {
    for (const end of ends) end();
    keep();
  });
  what.node.hidden = !lab.slime;
  picker.input.value = remembered.parameter;
  for (const input of Object.values(numbers)) input.addEventListener('input', show);
  chosen(picker.row);
  progress(lab.state?.video);

  function keep() {
    Object.assign(remembered, { what: what.value, parameter: picker.input.value, format: format.value });
    for (const [name, input] of Object.entries(numbers)) remembered[name] = input.value;
  }

  function chosen(row) {
    about.textContent = row ? `${row.meaning}; ${row.range}${row.unit ? `, ${row.unit}` : ''}; now ${row.value}` : '';
    if (row && typeof row.value === 'number' && numbers.from.value === '') numbers.from.value = String(row.value);
    show();
  }

  function frames() {
    return what.value === 'sweep' ? numberOf(numbers.frames) : numberOf(numbers.duration) * numberOf(numbers.fps);
  }

  /* The time is extrapolated from the current image: frames differ. */
  function show() {
    sweep.hidden = what.value !== 'sweep';
    motion.hidden = what.value === 'sweep';
    const n = Math.max(1, Math.round(frames()));
    const one = lab.image?.final ? lab.image.wall_s : NaN;
    const { full_width: width, full_height: height } = lab.image || {};
    const parts = [
      Number.isFinite(n) && `${count(n)} frames, ${seconds(n / numberOf(numbers.fps))} long`,
      Number.isFinite(n * one) && `about ${seconds(n * one)} if each takes as long as the current image`,
      format.value === 'y4m' && Number.isFinite(n * width) && `${count(1.5 * n * width * height)}B`,
    ];
    length.textContent = parts.filter(Boolean).join('; ');
  }

  /* The request, or null with the first wrong field focused. */
  function request() {
    const body = { fps: numberOf(numbers.fps), format: format.value };
    const names = what.value === 'sweep' ? ['from', 'to', 'frames', 'fps'] : ['fps'];
    if (what.value === 'sweep' && !picker.row) return wrong('Choose a parameter of the scene.', picker.input);
    for (const name of names)
      if (!Number.isFinite(numberOf(numbers[name]))) return wrong('Enter a number.', numbers[name]);
    if (what.value === 'sweep')
      return {
        ...body,
        parameter: picker.row.path,
        from: numberOf(numbers.from),
        to: numberOf(numbers.to),
        frames: numberOf(numbers.frames),
      };
    return numbers.duration.value === '' ? body : { ...body, duration_s: numberOf(numbers.duration) };
  }

  function wrong(text, input) {
    replace(trouble, notice(text, { kind: 'error' }));
    input.focus();
    return null;
  }

  function fail(error) {
    replace(trouble, notice(error.message, { kind: 'error', remedy: error.remedy }));
  }

  async function act() {
    const body = request();
    if (!body) return;
    keep();
    replace(trouble);
    try {
      progress(await lab.post('/api/video', body));
    } catch (error) {
      fail(error);
    }
  }

  function progress(now) {
    render.disabled = Boolean(now?.running);
    stop.hidden = bar.hidden = !now?.running;
    if (now?.running) {
      bar.value = now.done / now.frames;
      const left = now.left_s === null ? '' : `, about ${seconds(Math.max(1, Math.round(now.left_s)))} left`;
      words.textContent = `${now.done} of ${now.frames} frames${left}`;
    } else {
      words.textContent = now?.bytes
        ? `${now.frames} frames in ${seconds(now.wall_s)}; ${count(now.bytes)}B`
        : now && !now.error
          ? 'Stopped.'
          : '';
    }
    if (now?.error) fail({ message: now.error.error, remedy: now.error.remedy });
    finished(now?.bytes ? now : null);
  }

  /* The file changes only with a new video, which has another time. */
  function finished(video) {
    const key = video ? `${video.format} ${video.wall_s}` : '';
    if (result.dataset.key === key) return;
    result.dataset.key = key;
    if (!video) return void replace(result);
    const address = `/api/video/file?of=${video.wall_s}`;
    const name = `${lab.name()}-video.${ENDINGS[video.format]}`;
    const image = video.format === 'apng' ? element('img', { class: 'video-image', alt: 'The video' }) : null;
    if (image) showImage(lab, image, address);
    const save = async () => download(await lab.engine.address(address), name);
    replace(
      result,
      image,
      button('Save file', () => save().catch(fail), { icon: 'download', kind: 'primary' }),
    );
    result.scrollIntoView({ block: 'nearest' });
  }
}
