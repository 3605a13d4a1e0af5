/* The figures of a study.
 * exports:
 *   createFigures(lab) -> {node, show(study, details, running), grew(ended)}   the figures that scripts in plots/ draw
 *   createSave(lab, chosen) -> {node, show(study, rows, running)}           saves the figure of `cuvette study plot`
 *                                                                           with the choices of the chart; chosen()
 *                                                                           as in chart.js */

import { say } from '../shared/language.js';
import { showImage } from '../shared/images.js';
import { button, checkbox, download, element, empty, notice, replace } from '../shared/ui.js';

export function createFigures(lab) {
  const messages = element('div');
  const list = element('div', { class: 'study-figures' });
  const draw = button('Draw with gnuplot', () => ask(), { icon: 'chart', small: true });
  const along = checkbox('Redraw when the study ends', false);
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
    draw.title = rows ? drawable.join(', ') : say('available when there are rows');
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
            ? say('{figures} can be drawn when there are rows.', { figures: drawable.join(', ') })
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
    const image = element('img', { alt: say('Figure {name}, drawn from the rows by plots/{name}.gp', { name }) });
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

const FORMATS = ['SVG', 'PNG', 'PDF'];

/* The options of `cuvette study plot`; scales are passed only if the user changed one of them. */
function optionsOf({ quantity, x, by, logX, logY }, format) {
  const options = new URLSearchParams({ format });
  if (quantity) options.set('y', quantity);
  if (x) options.set('x', x);
  if (by) options.set('by', by);
  if (logX !== null || logY !== null) options.set('log', `${logX ? 'x' : ''}${logY ? 'y' : ''}` || 'none');
  return options;
}

export function createSave(lab, chosen) {
  const messages = element('div');
  const buttons = FORMATS.map((name) =>
    button(say('Save figure as {format}', { format: name }), () => save(name.toLowerCase()), {
      icon: 'download',
      small: true,
    }),
  );
  const node = element('div', { class: 'study-part' }, element('div', { class: 'buttons' }, buttons), messages);
  let study = null;
  let busy = false;
  let possible = false;
  return { node, show };

  function show(next, rows, running) {
    if (next.name !== study?.name) replace(messages);
    study = next;
    possible = rows > 0 && !running;
    node.hidden = !rows;
    enable();
    for (const one of buttons)
      one.title = running ? say('available after the study ends: drawing would disturb it') : '';
  }

  function enable() {
    for (const one of buttons) one.disabled = busy || !possible;
  }

  async function save(format) {
    if (busy) return;
    const of = study;
    busy = true;
    enable();
    try {
      const { blob } = await lab.blob(
        `/api/studies/${encodeURIComponent(of.name)}/figure?${optionsOf(chosen(), format)}`,
      );
      download(blob, `${of.name}.${format}`);
      replace(messages);
    } catch (error) {
      if (of.name === study.name) replace(messages, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
    busy = false;
    enable();
  }
}
