/* The links of the dialog Share: to copy, as a QR code, and as a frame for the page of a learning platform.
 * exports: createLinks(lab, {code, print, copied}) -> node
 *   code: promise of the text after # that holds the scene, null if the scene cannot be shared
 *   print(title, drawing, address): prints a QR code
 *   copied(text): called when something was copied, with a message */

import { named } from './address.js';
import { say } from './language.js';
import { QR_MOST, qrCode } from './qr.js';
import { qrDrawing } from './qr_drawing.js';
import { button, choice, copy, element, memory, notice, replace, text } from './ui.js';

const SITE = 'share.site';

/* A page within another one, as in a notebook, has no address: only the fragment is copied. */
const pageAddress = () => (location.protocol === 'about:' ? '' : new URL(location.pathname, location.href).href);

/* Whether other machines can open the address of this page. */
const isPublic = () => /^https?:$/.test(location.protocol) && !/^(localhost|127\.|\[::1\])/.test(location.hostname);

/* The address of a laboratory on the web, as the user typed it; '' if it is none. */
function siteAddress(words) {
  try {
    const { protocol, origin, pathname } = new URL(words);
    return /^https?:$/.test(protocol) ? origin + pathname : '';
  } catch {
    return '';
  }
}

const escaped = (words) => words.replace(/&/g, '&amp;').replace(/"/g, '&quot;').replace(/</g, '&lt;');

export function createLinks(lab, { code, print, copied }) {
  let scene = ''; /* the fragment with the scene; '' before it is there */
  const { lesson } = named();
  const what = choice({
    label: 'Link to',
    choices: [
      ['lesson', 'the lesson'],
      ['scene', 'the scene as it is'],
    ],
    value: lesson ? 'lesson' : 'scene',
    radios: true,
    onchange: show,
  });
  const site = text({
    label: 'Laboratory on the web',
    value: memory.get(SITE, ''),
    placeholder: 'https://school.example/laboratory/',
    onchange(words) {
      memory.set(SITE, words.trim());
      show();
    },
  });
  const address = element('input', { class: 'input', readonly: true, 'aria-label': 'Link' });
  const where = element('p', { class: 'hint' });
  const frame = element('textarea', { class: 'input share-frame', readonly: true, rows: 4, 'aria-label': 'Frame' });
  const frameHint = element('p', { class: 'hint' });
  const drawing = element('div', { class: 'share-qr' });
  const copyLink = copyButton('Copy link', address, 'Link copied.');
  const copyFrame = copyButton('Copy frame', frame, 'The frame is on the clipboard.');
  const printCode = button('Print QR code', () => print(titleOf(), qrDrawing(qrCode(address.value)), address.value), {
    small: true,
  });
  const parts = element(
    'div',
    { class: 'share-links' },
    lesson ? what.node : null,
    isPublic() ? null : site.node,
    element('div', { class: 'share-row' }, address, copyLink),
    where,
    part('QR code', drawing, element('div', { class: 'buttons' }, printCode)),
    part('In a page of a learning platform', frame, element('div', { class: 'buttons' }, copyFrame), frameHint),
  );
  parts.hidden = true;
  code.then((fragment) => {
    if (fragment === null) return;
    scene = fragment;
    parts.hidden = false;
    show();
  });
  return parts;

  function copyButton(label, from, done) {
    return button(label, () => copy(from.value).then(() => copied(done), lab.fail), { icon: 'copy', small: true });
  }

  function part(title, ...content) {
    return element('details', { class: 'share-part' }, element('summary', { text: title }), content);
  }

  function titleOf() {
    return lab.state.title || 'Cuvette';
  }

  function show() {
    const fragment = lesson && what.value === 'lesson' ? `#lesson=${lesson}` : scene;
    const other = isPublic() ? '' : siteAddress(site.value);
    const own = lab.engine.kind === 'server' && !other;
    const base = other || pageAddress();
    address.value = base + fragment;
    where.textContent = placeOf(own);
    const query = own ? '?embed=1&token=TOKEN' : '?embed=1';
    frame.value =
      `<iframe src="${escaped(base + query + fragment)}" title="${escaped(titleOf())}"\n` +
      '  width="960" height="640" style="border: 0" allow="fullscreen; clipboard-write"></iframe>';
    frameHint.textContent = own
      ? 'Shows the laboratory of this machine. Start it with --embed-origin and the address of the platform, and ' +
        'replace TOKEN by that of the printed address, which changes at each start.'
      : 'Shows the image with its tools, without the panels; the reader can open the whole laboratory from there.';
    showCode(own);
  }

  function placeOf(own) {
    if (own) return 'Opens in a laboratory at the same address on this machine. For others, name one on the web above.';
    return 'The link holds what it shows, and opens in any browser that can reach that laboratory.';
  }

  function showCode(own) {
    const made = qrCode(address.value);
    const trouble = own
      ? notice('A telephone cannot reach this machine.', { remedy: 'name a laboratory on the web above' })
      : made
        ? null
        : notice(
            say('The link has {length} characters; a QR code holds {most}.', {
              length: address.value.length,
              most: QR_MOST,
            }),
            { kind: 'warning', remedy: 'share the lesson or an HTML file, or remove objects from the scene' },
          );
    printCode.disabled = Boolean(trouble);
    if (trouble) return replace(drawing, trouble);
    const image = qrDrawing(made);
    image.setAttribute('aria-label', 'QR code of the link');
    return replace(drawing, image);
  }
}
