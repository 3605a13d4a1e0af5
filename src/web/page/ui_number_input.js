/* The input of a number field. It accepts a decimal comma as well as a point, in every language of the browser: an
 * input of type number drops one of them, so that 1,5 becomes 15.
 * exports:
 *   numberInput({min, max, step, ..attributes}) -> input     arrow keys change it by a step; step 'any' means 1
 *   numberOf(input)                                          its number; NaN for an empty field or another text */

import { element } from './ui_base.js';

const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

/* A thousands separator is rejected: 1,234.5 and 1.234,5 would be read as different numbers in different countries. */
function parse(text) {
  const plain = text
    .trim()
    .replace(/^\u2212/, '-')
    .replace(',', '.');
  return NUMBER.test(plain) ? Number(plain) : NaN;
}

export const numberOf = (input) => parse(input.value);

function problem(input) {
  if (input.value.trim() === '') return '';
  const value = numberOf(input);
  const { min, max, step } = input.dataset;
  if (!Number.isFinite(value)) return 'Enter a number, such as 1.5 or 1,5, without thousands separators.';
  if (min !== undefined && value < Number(min)) return `Enter a number of at least ${min}.`;
  if (max !== undefined && value > Number(max)) return `Enter a number of at most ${max}.`;
  if (step === '1' && !Number.isInteger(value)) return 'Enter a whole number.';
  return '';
}

function stepped(input, way) {
  const { min = -Infinity, max = Infinity, step } = input.dataset;
  const by = Number(step) > 0 ? Number(step) : 1;
  const next = (numberOf(input) || 0) + way * by;
  return Number(Math.min(Number(max), Math.max(Number(min), next)).toPrecision(12));
}

export function numberInput({ min, max, step = 'any', class: name = 'input numeric', ...attributes } = {}) {
  const input = element('input', {
    type: 'text',
    role: 'spinbutton',
    /* The keypad of decimals has no minus on some telephones. */
    inputmode: min >= 0 ? 'decimal' : 'text',
    autocomplete: 'off',
    spellcheck: 'false',
    class: name,
    'aria-valuemin': Number.isFinite(min) ? min : null,
    'aria-valuemax': Number.isFinite(max) ? max : null,
    ...attributes,
  });
  if (Number.isFinite(min)) input.dataset.min = min;
  if (Number.isFinite(max)) input.dataset.max = max;
  input.dataset.step = step;
  const check = () => {
    const value = numberOf(input);
    input.setCustomValidity(problem(input));
    if (Number.isFinite(value)) input.setAttribute('aria-valuenow', value);
    else input.removeAttribute('aria-valuenow');
  };
  for (const event of ['focus', 'input', 'change']) input.addEventListener(event, check);
  input.addEventListener('keydown', (event) => {
    const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!way || event.ctrlKey || event.altKey || event.metaKey || input.disabled) return;
    input.value = String(stepped(input, way));
    for (const type of ['input', 'change']) input.dispatchEvent(new Event(type, { bubbles: true }));
    event.preventDefault();
  });
  return input;
}
