/* Draws the reference image A and the difference map over the newest image B.
 *
 * exports: createCompareView(lab, onsplit(fraction)) -> {set({a, map, mode, fraction, strength, pixel}), flip(on)}
 *   a, map      paths of images of B's size, or null
 *   mode        'b': only B; 'wipe': A to the left of the handle, over the fraction 0..1 of the width; 'map': the
 *               map with opacity strength 0..1
 *   pixel       [x, y], a pixel to frame, or null
 * The handle is dragged with the pointer or moved with the arrow keys. */

import { dragging } from '../shared/escape.js';
import { showImage } from '../shared/images.js';
import { element, svg, unique } from '../shared/ui.js';

const EDGE = 0.05; /* the letter of a part that is narrower than this fraction is hidden */

export function createCompareView(lab, onsplit) {
  const { view } = lab;
  const part = svg('rect', { x: 0, y: 0 });
  const clip = unique('wipe');
  const a = svg('image', { 'clip-path': `url(#${clip})`, preserveAspectRatio: 'none' });
  const map = svg('image', { preserveAspectRatio: 'none' });
  const edge = svg('path', { class: 'wipe-edge' });
  const frame = svg('path', { class: 'wipe-spot' });
  const handle = element('button', {
    type: 'button',
    class: 'wipe-handle',
    role: 'slider',
    'aria-label': 'Fraction of the reference image',
    'aria-valuemin': 0,
    'aria-valuemax': 100,
    'aria-orientation': 'horizontal',
    hidden: true,
    onpointerdown(event) {
      const { fraction } = now;
      handle.setPointerCapture(event.pointerId);
      endDrag = dragging(() => {
        handle.releasePointerCapture(event.pointerId);
        onsplit(fraction);
      });
    },
    onlostpointercapture: () => endDrag(),
    onpointermove: (event) => {
      if (handle.hasPointerCapture(event.pointerId))
        onsplit(Math.min(1, Math.max(0, view.fromEvent(event).x / view.width)));
    },
    onkeydown: (event) => {
      const step = {
        ArrowLeft: -0.02,
        ArrowDown: -0.02,
        ArrowRight: 0.02,
        ArrowUp: 0.02,
        PageDown: -0.1,
        PageUp: 0.1,
        Home: -1,
        End: 1,
      }[event.key];
      if (step === undefined) return;
      onsplit(Math.min(1, Math.max(0, now.fraction + step)));
      event.preventDefault();
      event.stopPropagation();
    },
  });
  const labels = ['A', 'B'].map((name) =>
    element('span', { class: name === 'B' ? 'wipe-label right' : 'wipe-label', text: name, hidden: true }),
  );
  const layer = view.layer('compare');
  let now = { a: null, map: null, mode: 'b', fraction: 0.5, strength: 1, pixel: null };
  let flipped = false;
  let endDrag = null;

  layer.append(svg('clipPath', { id: clip }, part), a, map, edge, frame);
  layer.parentNode.prepend(layer);
  view.overlay.append(handle, ...labels);
  lab.on('view', draw);
  return {
    set(next) {
      now = { ...now, ...next };
      draw();
    },
    flip(on) {
      flipped = on && Boolean(now.a);
      draw();
    },
  };

  function draw() {
    const wiping = now.mode === 'wipe' && Boolean(now.a) && !flipped;
    const fraction = flipped ? 1 : wiping ? now.fraction : 0;
    const { width, height } = view;
    for (const image of [a, map]) {
      for (const [name, value] of Object.entries({ width, height })) image.setAttribute(name, value);
      /* Smoothed in the same way as B. */
      image.style.imageRendering = view.scale * devicePixelRatio < 2 ? 'auto' : 'pixelated';
    }
    showImage(lab, a, now.a);
    showImage(lab, map, now.map);
    part.setAttribute('width', Math.max(0, fraction * width));
    part.setAttribute('height', height);
    a.style.display = fraction > 0 ? '' : 'none';
    map.style.display = now.mode === 'map' && now.map && !flipped ? '' : 'none';
    map.setAttribute('opacity', now.strength);
    edge.setAttribute('d', wiping ? `M${fraction * width} 0V${height}` : '');
    frame.setAttribute('d', now.pixel ? `M${now.pixel}h1v1h-1z` : '');
    place(wiping, fraction);
  }

  function place(wiping, fraction) {
    const at = view.toScreen(fraction * view.width, view.height / 2);
    const top = view.toScreen(0, 0);
    const right = view.toScreen(view.width, 0);
    handle.hidden = !wiping;
    handle.setAttribute('aria-valuenow', Math.round(100 * fraction));
    handle.setAttribute('aria-valuetext', `A ${Math.round(100 * fraction)} %`);
    Object.assign(handle.style, { left: `${at.x}px`, top: `${at.y}px` });
    labels[0].hidden = !(wiping && fraction > EDGE) && !flipped;
    labels[1].hidden = !(wiping && fraction < 1 - EDGE);
    Object.assign(labels[0].style, { left: `${Math.max(0, top.x)}px`, top: `${Math.max(0, top.y)}px` });
    Object.assign(labels[1].style, { left: `${right.x}px`, top: `${Math.max(0, right.y)}px` });
  }
}
