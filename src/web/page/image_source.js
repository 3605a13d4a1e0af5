/* Which encoding of the newest image to fetch: while changes follow each other, before the final pass, and first of all
 * on a slow link, a small JPEG; at rest the PNG, which is exact.
 *
 * exports: createImageSource(lab) -> {quick(shown) -> bool, fetch(quick) -> {blob, head}}
 *   head: {serial, generation, pass, final, exact}; exact: a PNG. lab.fail is not called. */

const SLOW_S = 0.4; /* a link on which a PNG takes longer is slow */
const PNG_BYTES = 300e3; /* before the first PNG */
const MEASURED_BYTES = 20e3; /* smaller images do not show the speed of a link */

export function createImageSource(lab) {
  let pngBytes = PNG_BYTES;
  let bytesPerS = Infinity;

  return {
    quick: (shown) =>
      lab.dragging() ||
      !lab.newestPass.final ||
      (pngBytes / bytesPerS > SLOW_S && shown?.serial !== lab.newestPass.serial),
    fetch,
  };

  async function fetch(quick) {
    const { blob, headers, seconds } = await lab.blob(quick ? '/api/picture.jpg?quick=1' : '/api/picture.png');
    if (!quick) pngBytes = blob.size;
    if (blob.size >= MEASURED_BYTES) bytesPerS = blob.size / Math.max(seconds, 1e-3);
    const number = (name) => Number(headers.get(`X-Cuvette-${name}`));
    return {
      blob,
      head: {
        serial: number('Serial'),
        generation: number('Generation'),
        pass: number('Pass'),
        final: number('Final') === 1,
        exact: !quick,
      },
    };
  }
}
