/* The range of a slider: a parameter's bounds, or a useful part of wide bounds.
 * exports: workingRange(row, value) -> {min, max, step, log} for scale() of ui_controls.js */

const WIDE = 1000; /* wider bounds are reduced */
const DECADES = 6; /* positive bounds that span more decades about the default give a logarithmic slider */
const STEPS = 400;

function niceAbove(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return power * [1, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10].find((step) => step * power >= x * (1 - 1e-12));
}

const stepOf = (span, integer) => (integer ? 1 : 10 ** Math.floor(Math.log10(span / STEPS)));
const component = (x) => (Array.isArray(x) ? Math.max(...x.map(Math.abs)) : Math.abs(x ?? 0));

export function workingRange(row, value) {
  const integer = row.type === 'integer';
  const low = row.lowest ?? -Infinity;
  const high = row.highest ?? Infinity;
  if (high - low <= WIDE) return { min: low, max: high, step: stepOf(high - low, integer), log: false };
  const size = Math.max(component(row.default), component(row.initial), component(value));
  const middle = Math.sqrt(low * high);
  if (low > 0 && Math.log10(high / low) >= DECADES && size > 0 && middle / size < 100 && size / middle < 100) {
    const ref = component(row.default) || size;
    return {
      min: Math.max(low, Math.min(ref, component(value)) / 100),
      max: Math.min(high, 100 * Math.max(ref, component(value))),
      step: integer ? 1 : 0,
      log: true,
    };
  }
  if ((low === 0 && size === 0) || row.type === 'color')
    return { min: 0, max: Math.min(high, niceAbove(Math.max(100, 2 * component(value)))), step: 0, log: true };
  const max = Math.min(high, niceAbove(Math.max(2.5 * size, integer ? 16 : 1e-3)));
  const min = Math.max(low, low < 0 ? -max : 0);
  const step = stepOf(max - min, integer);
  return { min: row.above_lowest && min <= low ? step : min, max, step, log: false };
}
