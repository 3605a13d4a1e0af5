/* The language of the page. The English text is the key; the catalogue of the chosen language, languages/CODE.json, has
 * its translation, a text or one for each plural form. A text without a translation stays English.
 * The language is that of the address (?lang=de), else the one chosen in the page's head, else the browser's.
 * exports:
 *   say(text, values)      the translation with {name} replaced by values.name; a number gets the decimal mark; the
 *                          number {n} or {count} chooses the plural form. The text is a literal, for
 *                          tests/source/texts.py
 *   translated(text)       the translation of a constant, or the text itself; elements.js calls it for what it shows
 *   local(text)            the decimal point of a number as text is replaced by the language's mark
 *   language               the code in use, such as 'de'
 *   languages              {code: the language's name in itself}
 *   chooseLanguage(code)   remembers it, for the page's next start */

import { SINGULARS } from './singulars.js';

export const languages = { en: 'English', de: 'Deutsch', es: 'Español', ru: 'Русский' };
const PSEUDO = 'qps'; /* of tests: each text in brackets, longer */
const KEY = 'cuvette.language';

function stored() {
  try {
    return JSON.parse(localStorage.getItem(KEY));
  } catch {
    return null; /* storage is forbidden, or has another content */
  }
}

const known = (code) => code in languages || code === PSEUDO;
const preferences = [new URLSearchParams(location.search).get('lang'), stored(), ...(navigator.languages ?? [])];
export const language = preferences.map((tag) => String(tag).split('-')[0].toLowerCase()).find(known) ?? 'en';

export function chooseLanguage(code) {
  try {
    localStorage.setItem(KEY, JSON.stringify(code));
  } catch {
    /* the address names it */
  }
  const address = new URL(location.href);
  if (stored() === code) address.searchParams.delete('lang');
  else address.searchParams.set('lang', code);
  if (location.protocol !== 'about:') history.replaceState(null, '', address);
}

/* laboratory.html holds the catalogues as boot.js holds the engine; other pages load the chosen one. */
async function load(code) {
  if (code === 'en') return {};
  const part = document.getElementById(`cuvette-language-${code}`);
  if (part) {
    const packed = await fetch(`data:;base64,${part.textContent}`);
    return new Response(packed.body.pipeThrough(new DecompressionStream('gzip'))).json();
  }
  const reply = await fetch(new URL(`languages/${code}.json`, document.baseURI), { credentials: 'same-origin' });
  return reply.json();
}

let failed = false;
const catalogue = await load(language).catch(() => {
  failed = true; /* English is better than no page */
  return {};
});
const spoken = failed ? 'en' : language;
document.documentElement.lang = spoken === PSEUDO ? 'en' : spoken;
const plurals = new Intl.PluralRules(document.documentElement.lang);
const mark = (1.5).toLocaleString(document.documentElement.lang)[1];

export const local = (text) => (mark === '.' ? text : text.replace('.', mark));

const has = (text) => Object.hasOwn(catalogue, text);

/* The surroundings of a text are not part of the key: ' index', 'index: '. */
export function translated(text) {
  if (spoken === 'en' || typeof text !== 'string') return text;
  if (has(text)) return form(catalogue[text]);
  const inner = text.trim();
  return inner !== text && has(inner) ? text.replace(inner, () => form(catalogue[inner])) : text;
}

const form = (entry, n) => (typeof entry === 'string' ? entry : (entry[plurals.select(n)] ?? entry.other));

function template(text, n) {
  if (has(text)) return form(catalogue[text], n);
  return n === 1 && Object.hasOwn(SINGULARS, text) ? SINGULARS[text] : text;
}

/* The number of a plural form; NaN, so the form for others, if the text is not a plain number. */
const countOf = ({ n, count = n }) => (typeof count === 'string' ? Number(count.replace(/\s/g, '')) : count);

const shown = (value) => (typeof value === 'number' ? local(String(value)) : value);

export const say = (text, values = {}) =>
  template(text, countOf(values)).replace(/\{(\w+)\}/g, (whole, name) => shown(values[name]) ?? whole);

/* The texts of index.html. */
for (const node of document.body.querySelectorAll('[aria-label], .skip')) {
  if (node.ariaLabel) node.ariaLabel = translated(node.ariaLabel);
  else node.textContent = translated(node.textContent);
}
