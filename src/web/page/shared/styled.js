/* Copies of SVG elements that need no style sheet, for files.
 * exports: styled(from, {drops(child), scale}) -> a copy with the computed style as attributes, without names for the
 *          page and its reader. drops: children without a copy; scale: CSS pixels per unit, for strokes that keep their
 *          width on the screen */

const STYLE = [
  'fill',
  'fill-opacity',
  'fill-rule',
  'stroke',
  'stroke-width',
  'stroke-opacity',
  'stroke-dasharray',
  'stroke-linecap',
  'stroke-linejoin',
  'paint-order',
  'opacity',
  'font-size',
  'font-weight',
  'font-family',
  'text-anchor',
];
const BLENDING = { 'mix-blend-mode': 'normal', isolation: 'auto' };
const OF_THE_PAGE = ['class', 'style', 'tabindex', 'role', 'aria-label', 'aria-pressed'];

const scaled = (lengths, scale) => lengths.replace(/[\d.]+/g, (length) => String(Number(length) / scale));

export function styled(from, { drops = () => false, scale = 1 } = {}) {
  const to = from.cloneNode(false);
  const computed = getComputedStyle(from);
  for (const name of OF_THE_PAGE) to.removeAttribute(name);
  for (const name of Object.keys(to.dataset)) delete to.dataset[name];
  for (const name of from.childElementCount ? ['opacity'] : STYLE) {
    const value = computed.getPropertyValue(name);
    if (value) to.setAttribute(name, value);
  }
  if (computed.vectorEffect === 'non-scaling-stroke' && to.localName !== 'text')
    for (const name of ['stroke-width', 'stroke-dasharray'])
      if (to.hasAttribute(name)) to.setAttribute(name, scaled(to.getAttribute(name), scale));
  for (const [name, usual] of Object.entries(BLENDING)) {
    const value = computed.getPropertyValue(name);
    if (value && value !== usual) to.style.setProperty(name, value);
  }
  to.append(
    ...[...from.childNodes]
      .filter((child) => child.nodeType === Node.TEXT_NODE || !isLeftOut(child, drops))
      .map((child) => (child.nodeType === Node.TEXT_NODE ? child.cloneNode() : styled(child, { drops, scale }))),
  );
  return to;
}

const isLeftOut = (child, drops) => drops(child) || getComputedStyle(child).display === 'none';
