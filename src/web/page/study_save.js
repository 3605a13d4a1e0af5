/* Saving the figure of a study, drawn by `cuvette study plot` with the choices of the chart.
 * exports: createSave(lab, chosen) -> {node, show(study, rows, running)}; chosen() as of study_chart.js */

import { button, download, element, notice, replace } from './ui.js';

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
    button(`Save figure as ${name}`, () => save(name.toLowerCase()), { icon: 'save', small: true }),
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
    for (const one of buttons) one.title = running ? 'available after the study ends: drawing would disturb it' : '';
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
