/* Saved pages that hold the laboratory, where the engine is in this page: it leaves a place for the laboratory
 * (report/page.h). The site tells the text of the laboratory in one file (src/web/site/boot.js).
 * exports: PLACE_FOR_LABORATORY                the query of /api/page.html for a page with that place
 *          withLaboratory(blob) -> promise of a blob: the page with the laboratory; as it is where there is no place,
 *                                  or no laboratory in one file */

export const PLACE_FOR_LABORATORY = 'live=empty';
const PLACE = 'id="cuvette-live">';

const base64 = (blob) =>
  new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result.split(',')[1]);
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(blob);
  });

export async function withLaboratory(blob) {
  const [before, after] = (await blob.text()).split(PLACE, 2);
  const laboratory = after === undefined ? null : await globalThis.cuvetteDocument?.().catch(() => null);
  if (!laboratory) return blob;
  const packed = new Blob([laboratory]).stream().pipeThrough(new CompressionStream('deflate'));
  const code = await base64(await new Response(packed).blob());
  return new Blob([before, PLACE, code, after], { type: blob.type });
}
