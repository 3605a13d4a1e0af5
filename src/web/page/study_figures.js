/* The figures that scripts in plots/ draw of a study. exports: createFigures(lab) -> {node, show(study, details,
 * running), grew()} */

import { button, check, element, empty, notice, replace } from './ui.js';

export function createFigures(lab) {
  const said = element('div');
  const list = element('div', { class: 'study-figures' });
  const draw = button('Draw with gnuplot', () => ask(), { icon: 'chart', small: true });
  const along = check('Draw again when it has ended', false);
  const warning = element('p', {
    class: 'hint',
    text: 'Drawing would disturb what is measured now: these are drawn when it has ended or is stopped.',
  });
  const bar = element('div', { class: 'buttons' }, draw, along.node);
  const node = element('div', { class: 'study-part' }, bar, warning, said, list);
  let study = null;
  let busy = false;
  let version = 0;
  let names = '';
  return { node, show, grew };

  function show(next, { figures = [], drawable = [], rows }, running) {
    if (next.name !== study?.name) replace(said);
    study = next;
    bar.hidden = drawable.length === 0;
    draw.disabled = busy || !rows || running;
    draw.title = rows ? drawable.join(', ') : 'when there are rows';
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
      figures.map((name) =>
        element(
          'figure',
          {},
          element('img', {
            src: `/api/figures/${name}?drawn=${version}`,
            alt: `The figure ${name}, drawn from the rows by plots/${name}.gp`,
          }),
          element('figcaption', { class: 'hint', text: name }),
        ),
      ),
    );
  }

  /* More rows are there; ended: and no more will come for now. */
  function grew(ended) {
    if (along.value && !bar.hidden && ended) ask();
  }

  async function ask() {
    if (busy) return;
    busy = draw.disabled = true;
    const of = study;
    try {
      const told = await lab.post(`/api/studies/${encodeURIComponent(of.name)}/draw`, {});
      version++;
      if (of.name === study.name) {
        replace(
          said,
          told.complete
            ? null
            : notice('Not all figures could be drawn from the rows so far.', {
                kind: 'warning',
                remedy: told.said.slice(0, 400),
              }),
        );
        drawList(told.figures, []);
      }
    } catch (error) {
      if (of.name === study.name) replace(said, notice(error.message, { kind: 'error', remedy: error.remedy }));
    }
    busy = draw.disabled = false;
  }
}
