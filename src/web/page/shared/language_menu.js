/* The menu of languages in the page's head. Another language begins with a reload, after which the page shows what it
 * showed: the program keeps the scene, an engine in the browser keeps it as rescue.js does.
 * exports: languageMenu(lab) -> node */

import { chooseLanguage, language, languages, say } from './language.js';
import { ask, element } from './ui.js';

async function change(lab, code) {
  const kept = (await lab.rescue?.keep()) ?? true;
  const goes =
    kept ||
    (await ask(
      say('Language'),
      say('The page is loaded again, and this scene has changes that cannot be kept: save it first.'),
      say('Continue without saving'),
      'danger',
    ));
  if (!goes) return false;
  chooseLanguage(code);
  location.reload();
  return true;
}

export function languageMenu(lab) {
  const node = element(
    'select',
    {
      class: 'input select language',
      'aria-label': 'Language',
      title: 'Language',
      onchange: async () => {
        if (!(await change(lab, node.value))) node.value = language;
      },
    },
    Object.entries(languages).map(([code, name]) =>
      element('option', { value: code, lang: code, translate: 'no', selected: code === language, text: name }),
    ),
  );
  return node;
}
