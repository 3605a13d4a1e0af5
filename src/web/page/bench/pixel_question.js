/* The inspected pixel and its ray tree: one request at a time; only the newest of the waiting ones is sent.
 *
 * exports: createQuestion(lab) -> {pixel: {x, y} or null, tree or null, error or null, busy, ask(x, y), step(dx,
 * dy), again(), clear(), on(f), moved, old}
 * The rays stay where they are in the scene while the camera moves. After a change of the scene the pixel is traced
 * again at once, unless the camera has moved: the pixel then shows another ray, and `old` is true until again() is
 * called. moved: the camera has moved. */

import { buildTree } from './ray_tree.js';

export function createQuestion(lab) {
  const listeners = new Set();
  let asking = false;
  let waiting = false;
  let traced = null; /* what the tree depends on: {camera, rest} as texts */

  const question = {
    pixel: null,
    tree: null,
    error: null,
    busy: false,
    moved: false,
    old: false,
    ask,
    again: () => question.pixel && send(),
    clear,
    step(dx, dy) {
      if (question.pixel) ask(question.pixel.x + dx, question.pixel.y + dy);
    },
    on: (listener) => listeners.add(listener),
  };
  lab.view.behind(() => question.pixel && (question.busy || !isShown()));
  lab.on('image', (image) => {
    if (!question.pixel || !traced) return;
    if (question.pixel.x >= image.full_width || question.pixel.y >= image.full_height) {
      clear(); /* the image has become smaller */
      return;
    }
    if (!image.final || !lab.scene || lab.scene.generation < image.generation) return;
    const now = dependence();
    const moved = now.camera !== traced.camera;
    const changed = now.rest !== traced.rest;
    if (changed && !moved) send();
    else if (moved !== question.moved || changed !== question.old) {
      Object.assign(question, { moved, old: changed });
      notify();
    }
  });
  return question;

  function isShown() {
    return lab.image?.final && lab.image.generation >= lab.newestGeneration;
  }

  function dependence() {
    const camera = (lab.scene?.params || []).filter(({ group }) => group === 'camera').map(({ value }) => value);
    return { camera: JSON.stringify(camera), rest: lab.scene?.version };
  }

  function notify() {
    for (const listener of listeners) listener(question);
  }

  function ask(x, y) {
    const { width, height } = lab.view;
    if (!width) return;
    const at = (value, size) => Math.min(size - 1, Math.max(0, Math.floor(value)));
    question.pixel = { x: at(x, width), y: at(y, height) };
    send();
  }

  function clear() {
    Object.assign(question, { pixel: null, tree: null, error: null, moved: false, old: false });
    notify();
  }

  async function send() {
    waiting = true;
    question.busy = true;
    notify();
    if (asking) return;
    asking = true;
    while (waiting) {
      waiting = false;
      const { pixel } = question;
      if (pixel) await fetchTree(pixel);
    }
    asking = false;
    question.busy = false;
    notify();
  }

  async function fetchTree(pixel) {
    traced = dependence();
    try {
      const answer = await lab.get(`/api/trace?x=${pixel.x}&y=${pixel.y}`);
      if (question.pixel)
        Object.assign(question, { tree: { ...buildTree(answer), pixel }, error: null, moved: false, old: false });
    } catch (error) {
      if (question.pixel) Object.assign(question, { tree: null, error });
    }
    notify();
  }
}
