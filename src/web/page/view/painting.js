/* Fetches the newest pass and draws it: every image that is newer than the displayed one, also while the scene changes
 * faster than images come. Serials order the images, also while a slime moves within one generation. A final image that
 * was drawn from a JPEG is replaced by the exact one when the scene rests; only then lab.image.final is true.
 * At rest it is shown with the display's pixels (sharp_image.js).
 * exports: createPainting(canvas, view, place, lab) -> {paint, pixel, show} */

import { createSharp } from './sharp_image.js';

/* --- which encoding to fetch ---
 * A small JPEG while changes follow each other, before the final pass, and on a slow link as the first image of a pass;
 * otherwise the PNG, which is exact. The head of an image: {serial, generation, pass, final, exact}; exact: a PNG. */

const SLOW_S = 0.4; /* a link is slow if a PNG needs longer */
const PNG_BYTES = 300e3; /* assumed before the first PNG */
const MEASURED_BYTES = 20e3; /* smaller images do not show the speed of a link */

function createImageSource(lab) {
  let pngBytes = PNG_BYTES;
  let bytesPerS = Infinity;

  return {
    quick: (shown) =>
      lab.dragging() ||
      !lab.newestPass.final ||
      (pngBytes / bytesPerS > SLOW_S && shown?.serial !== lab.newestPass.serial),
    fetch,
  };

  async function fetch(quick) {
    const { blob, headers, seconds } = await lab.blob(quick ? '/api/image.jpg?quick=1' : '/api/image.png');
    if (!quick) pngBytes = blob.size;
    if (blob.size >= MEASURED_BYTES) bytesPerS = blob.size / Math.max(seconds, 1e-3);
    const number = (name) => Number(headers.get(`X-Cuvette-${name}`));
    return {
      blob,
      head: {
        serial: number('Serial'),
        generation: number('Generation'),
        pass: number('Pass'),
        final: number('Final') === 1,
        exact: !quick,
      },
    };
  }
}

/* --- drawing --- */

const REST_MS = 160; /* from the last image of a drag to the exact image */

const newer = (a, b) => Boolean(a) && (!b || a.serial > b.serial);

export function createPainting(canvas, view, place, lab) {
  const context = canvas.getContext('2d', { alpha: true });
  const probe = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
  const source = createImageSource(lab);
  const sharp = createSharp(lab, view, place, schedule);
  const passes = new Map();
  let bitmap = null;
  let instead = null;
  let shown = null;
  let fetching = false;
  let frame = 0;
  let rest = 0;

  lab.on('restarted', () => {
    shown = null;
    passes.clear();
  });
  lab.on('pass', onPass);
  lab.on('state', (state) => {
    if (state.image) onPass(state.image);
  });
  return { paint: schedule, pixel, show };

  function due() {
    return newer(lab.newestPass, shown) || (lacksExact() && !lab.dragging());
  }

  /* Whether the displayed image is the final one, but not exact. */
  function lacksExact() {
    return Boolean(shown?.final && !shown.exact) && shown.serial === lab.newestPass?.serial;
  }

  function onPass(pass) {
    const before = passes.get(pass.serial);
    passes.set(pass.serial, { ...before, ...pass });
    if (passes.size > 12) passes.delete(passes.keys().next().value);
    if (shown?.serial !== pass.serial) load();
    else if (!before) publish();
    else if (lab.image?.serial === pass.serial) Object.assign(lab.image, facts());
    complete();
  }

  /* Fetches the exact image when the scene rests. */
  function complete() {
    if (fetching || !lacksExact()) return;
    clearTimeout(rest);
    rest = setTimeout(load, lab.dragging() ? REST_MS : 0);
  }

  async function load() {
    if (fetching) return;
    fetching = true;
    let last = null;
    let failed = false;
    while (!failed && due() && (newer(lab.newestPass, last) || (last && !last.exact && lacksExact()))) {
      try {
        const { blob, head } = await source.fetch(source.quick(shown));
        if (newer(head, shown) || (head.serial === shown?.serial && head.exact && !shown.exact))
          draw(await createImageBitmap(blob, { colorSpaceConversion: 'none' }), head);
        last = head;
      } catch (error) {
        failed = true; /* the next pass, or a new connection, tries again */
        if (error.status !== 404 && error.status !== 0 && error.status !== 401) lab.fail(error);
      }
    }
    fetching = false;
    if (!failed) complete();
  }

  function draw(next, head) {
    if (bitmap) bitmap.close();
    bitmap = next;
    shown = head;
    publish();
  }

  function facts() {
    const about = passes.get(shown.serial); /* an image may come before the event that describes it */
    const final = Boolean(about) && shown.final && shown.exact;
    return { ...about, ...shown, final, film_hash: final ? about.film_hash : null };
  }

  function publish() {
    const about = passes.get(shown.serial) || {};
    const width = about.full_width || (shown.final ? bitmap.width : view.width || bitmap.width);
    const height = about.full_height || (shown.final ? bitmap.height : view.height || bitmap.height);
    const resized = width !== view.width || height !== view.height;
    view.width = width;
    view.height = height;
    lab.image = {
      ...facts(),
      width: bitmap.width,
      height: bitmap.height,
      full_width: width,
      full_height: height,
    };
    if (resized) place.fit();
    else schedule();
    lab.emit('image', lab.image);
    sharp.follow(shown);
  }

  async function show(blob) {
    const next = blob ? await createImageBitmap(blob, { colorSpaceConversion: 'none' }) : null;
    if (instead) instead.close();
    instead = next;
    schedule();
  }

  function schedule() {
    frame ||= requestAnimationFrame(paint);
  }

  function paint() {
    frame = 0;
    const ratio = devicePixelRatio;
    const width = Math.max(1, Math.round(place.width * ratio));
    const height = Math.max(1, Math.round(place.height * ratio));
    if (canvas.width !== width || canvas.height !== height) {
      Object.assign(canvas, { width, height });
      sharp.follow(shown);
    } else context.clearRect(0, 0, width, height);
    const drawn = instead || bitmap;
    if (!drawn || !view.width) return;
    const fine = instead ? null : sharp.of(shown);
    const coarse = drawn.width < view.width;
    context.imageSmoothingEnabled = Boolean(fine) || coarse || place.scale * ratio < 2;
    context.imageSmoothingQuality = lab.dragging() ? 'low' : 'high';
    context.drawImage(
      fine || drawn,
      place.left * ratio,
      place.top * ratio,
      view.width * place.scale * ratio,
      view.height * place.scale * ratio,
    );
  }

  function pixel(x, y) {
    const drawn = instead || bitmap;
    const column = Math.floor(x);
    const row = Math.floor(y);
    if (!drawn || column < 0 || row < 0 || column >= view.width || row >= view.height) return null;
    probe.clearRect(0, 0, 1, 1);
    const sx = Math.min(drawn.width - 1, Math.floor(((column + 0.5) * drawn.width) / view.width));
    const sy = Math.min(drawn.height - 1, Math.floor(((row + 0.5) * drawn.height) / view.height));
    probe.drawImage(drawn, sx, sy, 1, 1, 0, 0, 1, 1);
    return [...probe.getImageData(0, 0, 1, 1).data.slice(0, 3)];
  }
}
