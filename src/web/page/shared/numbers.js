/* Numbers as text, with the decimal mark of the page's language, and the sRGB curve.
 * exports: digits, seconds, timeUnit, count, vector, toLinear, toByte (see ui.js) */

import { local, say } from './language.js';

const MINUS = '\u2212';

export function digits(x, n = 4) {
  if (x === null || x === undefined || Number.isNaN(x)) return '–';
  if (!Number.isFinite(x)) return x > 0 ? '∞' : `${MINUS}∞`;
  const size = Math.abs(x);
  if (size !== 0 && (size >= 1e7 || size < 1e-4))
    return local(
      x
        .toExponential(Math.max(0, n - 1))
        .replace(/\.?0+e/, 'e')
        .replace('e+', 'e')
        .replace('-', MINUS),
    );
  return local(String(Number(x.toPrecision(n))).replace('-', MINUS));
}

/* The unit for a list of times in s, and the factor to it. */
export function timeUnit(times) {
  const largest = Math.max(0, ...times.filter((time) => Number.isFinite(time)).map(Math.abs));
  if (largest === 0 || largest >= 1) return { unit: 's', factor: 1 };
  return largest >= 1e-3 ? { unit: 'ms', factor: 1e3 } : { unit: 'µs', factor: 1e6 };
}

export function seconds(s) {
  if (s === null || s === undefined || !Number.isFinite(s)) return '–';
  if (s < 1e-3) return say('{time} µs', { time: digits(s * 1e6, 3) });
  if (s < 1) return say('{time} ms', { time: digits(s * 1e3, 3) });
  if (s < 60) return say('{time} s', { time: digits(s, 3) });
  const rounded = Math.round(s);
  const two = (whole) => String(whole).padStart(2, '0');
  const minutes = Math.floor(rounded / 60);
  if (rounded < 3600) return say('{minutes} min {seconds} s', { minutes, seconds: two(rounded % 60) });
  return say('{hours} h {minutes} min', { hours: Math.floor(rounded / 3600), minutes: two(minutes % 60) });
}

export function count(n) {
  if (n === null || n === undefined || !Number.isFinite(n)) return '–';
  if (Math.abs(n) < 1e5) return Math.round(n).toLocaleString('en').replaceAll(',', '\u2009');
  const [scale, unit] = n >= 1e12 ? [1e12, 'T'] : n >= 1e9 ? [1e9, 'G'] : n >= 1e6 ? [1e6, 'M'] : [1e3, 'k'];
  return `${digits(n / scale, 3)}\u2009${unit}`;
}

export const vector = (values, n = 4) => (values || []).map((x) => digits(x, n)).join(local('.') === ',' ? '; ' : ', ');

export const toLinear = (byte) => (byte / 255 <= 0.04045 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);

export function toByte(linear) {
  const x = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055));
}
