/* The final image at the display's resolution: while the scene rests, and the image is fitted into the view and thereby
 * enlarged, the program renders it once more with the display's pixels. It is only shown: the image, its hash, files
 * and the readout of pixels are those of the scene's own size. A change ends the frame, so that a drag is not slower.
 * exports: createSharp(lab, view, place, changed) -> {of(shown) -> a bitmap or null, follow(shown)} */

const LATER_MS = 400; /* after the final image */
const LEAST = 1.2; /* an image that would be enlarged by less stays as it is */
const MOST = 4; /* times the image's width; more than the program renders */
const PIXELS_MAX = 16777216;
const LONGEST_S = 6; /* expected time of the frame; a larger one is not requested */

export function createSharp(lab, view, place, changed) {
  let sharp = null; /* {serial, bitmap} */
  let timer = 0;
  let asked = '';

  return {
    of: (shown) => (place.fitted && sharp?.serial === shown?.serial ? sharp.bitmap : null),
    follow(shown) {
      clearTimeout(timer);
      if (sharp && sharp.serial !== shown?.serial) {
        sharp.bitmap.close();
        sharp = null;
      }
      /* In a browser the frame would keep the engine from the next change. */
      if (lab.engine.kind === 'server' && shown?.final && shown.exact) timer = setTimeout(ask, LATER_MS, shown);
    },
  };

  /* The pixels of the display, but not more than can be rendered in LONGEST_S, by the time of the final image. */
  function wanted() {
    const { width, height } = view;
    const affordable = Math.sqrt(LONGEST_S / Math.max(lab.image?.wall_s || 0, 1e-3));
    const most = Math.min(MOST, affordable, Math.sqrt(PIXELS_MAX / (width * height)));
    return Math.floor(width * Math.min(place.scale * devicePixelRatio, most));
  }

  async function ask(shown) {
    const width = wanted();
    const now = `${shown.serial} ${width}`;
    const have = sharp?.serial === shown.serial ? sharp.bitmap.width : view.width;
    if (!place.fitted || width < LEAST * have || now === asked || lab.dragging() || lab.study?.running) return;
    asked = now;
    try {
      const { blob, headers } = await lab.blob(`/api/display.png?width=${width}`);
      if (blob.type !== 'image/png') return void (asked = ''); /* the scene changed, or it takes too long */
      const bitmap = await createImageBitmap(blob, { colorSpaceConversion: 'none' });
      sharp?.bitmap.close();
      sharp = { serial: Number(headers.get('X-Cuvette-Serial')), bitmap };
      changed();
    } catch {
      asked = '';
    }
  }
}
