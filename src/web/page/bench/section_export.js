/* The drawing of a section as a file: what is on the screen, in the colours of a light page.
 * exports: sectionExports(lab, section) -> {saveSvg(), print(), copy() -> an SVG element with all its style} */

import { styled } from '../shared/styled.js';
import { download, element, svg } from '../shared/ui.js';

export function sectionExports(lab, section) {
  return { saveSvg, print, copy };

  /* Handles and focus are not part of it. */
  function copy() {
    const { node, port } = section;
    node.style.colorScheme = 'light';
    const paper = getComputedStyle(node).backgroundColor;
    const made = svg('svg', {
      xmlns: 'http://www.w3.org/2000/svg',
      width: port.width,
      height: port.height,
      viewBox: `0 0 ${port.width} ${port.height}`,
    });
    made.append(
      svg('title', {}, lab.state?.title || lab.name()),
      svg('rect', { width: port.width, height: port.height, fill: paper }),
      ...[...node.children]
        .filter((child) => !child.classList.contains('section-hand'))
        .map((child) => styled(child, { drops: (each) => each.classList.contains('grip') })),
    );
    node.style.colorScheme = '';
    return made;
  }

  function saveSvg() {
    const text = new XMLSerializer().serializeToString(copy());
    download(new Blob([text], { type: 'image/svg+xml' }), `${lab.name()}-section.svg`);
    lab.say('The drawing is saved.');
  }

  /* The browser's dialog prints on paper or into a PDF file, with text in any script. */
  function print() {
    const page = element('div', { class: 'section-print' }, copy());
    document.body.append(page);
    addEventListener('afterprint', () => page.remove(), { once: true });
    globalThis.print();
  }
}
