/* Modal dialogs. exports: dialog, ask (see ui.js) */

import { element, unique } from './ui_base.js';
import { icon } from './icons.js';

export function dialog({ title, content, actions = [['Close', null]], wide = false }) {
  const id = unique('dialog');
  let answer = null;
  let settle;
  const closed = new Promise((resolve) => {
    settle = resolve;
  });
  const close = (value = null) => {
    answer = value;
    if (node.open) node.close();
  };
  const buttons = actions.map(([label, value, kind]) =>
    element(
      'button',
      {
        type: 'button',
        class: kind ? `button ${kind}` : 'button',
        onclick: () => close(typeof value === 'function' ? value() : value),
      },
      element('span', { class: 'button-label', text: label }),
    ),
  );
  const node = element(
    'dialog',
    { class: wide ? 'dialog wide' : 'dialog', 'aria-labelledby': id },
    element(
      'header',
      { class: 'dialog-head' },
      element('h2', { id, text: title }),
      element(
        'button',
        { type: 'button', class: 'button quiet bare', title: 'Close', onclick: () => close(null) },
        icon('close'),
        element('span', { class: 'visually-hidden', text: 'Close' }),
      ),
    ),
    element('div', { class: 'dialog-body' }, content),
    buttons.length ? element('footer', { class: 'dialog-foot' }, buttons) : null,
  );
  node.addEventListener('close', () => {
    node.remove();
    settle(answer);
  });
  node.addEventListener('click', (event) => {
    if (event.target === node) close(null);
  });
  document.body.append(node);
  node.showModal();
  return { node, close, closed };
}

export const ask = (title, words, yes = 'Yes', kind = 'primary') =>
  dialog({
    title,
    content: element('p', { text: words }),
    actions: [
      ['Cancel', false],
      [yes, true, kind],
    ],
  }).closed.then(Boolean);
