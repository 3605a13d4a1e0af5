/* The inspected pixel and its ray tree: one request at a time; of the waiting ones only the newest is sent.
 *
 * exports: createQuestion(lab) -> {pixel: {x, y} or null, tree or null, error or null, busy, ask(x, y), step(dx,
 * dy), clear(), on(f)}
 * The tree is requested again after each new final image. */

import { buildTree } from './ray_tree.js';

export function createQuestion(lab) {
  const listeners = new Set();
  let asking = false;
  let waiting = false;
  let tracedSerial = -1; /* the serial of the displayed image at the time of the request */

  const question = {
    pixel: null,
    tree: null,
    error: null,
    busy: false,
    ask,
    clear,
    step(dx, dy) {
      if (question.pixel) ask(question.pixel.x + dx, question.pixel.y + dy);
    },
    on: (listener) => listeners.add(listener),
  };
  lab.on('picture', (picture) => {
    if (!question.pixel || !picture.final || picture.serial === tracedSerial) return;
    if (question.pixel.x < picture.full_width && question.pixel.y < picture.full_height) send();
    else clear(); /* the image has become smaller */
  });
  return question;

  function tell() {
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
    Object.assign(question, { pixel: null, tree: null, error: null });
    tell();
  }

  async function send() {
    waiting = true;
    question.busy = true;
    tell();
    if (asking) return;
    asking = true;
    while (waiting) {
      waiting = false;
      const { pixel } = question;
      if (pixel) await fetchTree(pixel);
    }
    asking = false;
    question.busy = false;
    tell();
  }

  async function fetchTree(pixel) {
    tracedSerial = lab.picture?.serial ?? -1;
    try {
      const answer = await lab.get(`/api/trace?x=${pixel.x}&y=${pixel.y}`);
      if (question.pixel) Object.assign(question, { tree: { ...buildTree(answer), pixel }, error: null });
    } catch (error) {
      if (question.pixel) Object.assign(question, { tree: null, error });
    }
    tell();
  }
}
