/* The figures that scripts in plots/ draw of a study. exports: createFigures(lab) -> {node, show(study, details,
 * running), grew()} */

import { showImage } from './image_address.js';
import { button, check, element, empty, notice, replace } from './ui.js';

export function createFigures(lab) {
  const messages = element('div');
  const list = element('div', { class: 'study-figures' });
  const draw = button('Draw with gnuplot', () => ask(), { icon: 'chart', small: true });
  const along = check('Redraw when the study ends', false);
  const warning = element('p', {
    class: 'hint',
    text: 'Drawing would disturb the measurement: these figures are drawn after the study ends or is stopped.',
  });
  const bar = element('div', { class: 'buttons' }, draw, along.node);
  const node = element('div', { class: 'study-part' }, bar, warning, messages, list);
  let study = null;
  let busy = false;
  let version = 0;
  let names = '';
  return { node, show, grew };

  function show(next, { figures = [], drawable = [], rows }, running) {
    if (next.name !== study?.name) replace(messages);
    study = next;
    bar.hidden = drawable.length === 0;
    draw.disabled = busy || !rows || running;
    draw.title = rows ? drawable.join(', ') : 'available when there are rows';
    warning.hidden = bar.hidden || !running;
    drawList(figures, drawable);
  }

  function drawList(figures, drawable) {
    const key = `${study.name} ${version} ${figures.join()}`;
    if (key === names) return;
    names = key;
    if (!figures.length) {
      replace(
        list,
        empty(
          drawable.length
            ? `${drawable.join(' and ')} can be drawn when there are rows.`
            : 'No script in plots/ draws a figure of this study.',
        ),
      );
      return;
    }
    replace(
      list,
      figures.map((name) => element('figure', {}, figure(name), element('figcaption', { class: 'hint', text: name }))),
    );
  }

  function figure(name) {
    const image = element('img', { alt: `Figure ${name}, drawn from the rows by plots/${name}.gp` });
    showImage(lab, image, `/api/figures/${name}?drawn=${version}`);
    return image;
  }

  /* Called when rows were added; ended: the study has stopped. */
  function grew(ended) {
    if (along.value && !bar.hidden && ended) ask();
  }

  async function ask() {
    if (busy) return;
    busy = draw.disabled = true;
    const of = study;
    try {
      const reply = await lab.post(`/api/studies/${encodeURIComponent(of.name)}/draw`, {});
      version++;
      if (of.name === study.name) {
        replace(
          messages,
          reply.complete
            ? null
            : notice('Some figures could not be drawn from the current rows.', {
                kind: 'warning',
                remedy: reply.said.slice(0, 400),
              }),
        );
        drawList(reply.figures, []);
      }
    } catch (error) {
      if (of.name === study.name) replace(messages, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
    busy = draw.disabled = false;
  }
}
