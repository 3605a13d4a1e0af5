/* Saved pages that hold the laboratory, where the engine is in this page: it leaves a place for the laboratory
 * (report/page_live.h). The laboratory in one file is this page itself, or next to its folder (src/web/site).
 * exports: PLACE_FOR_LABORATORY                the query of /api/page.html for a page with that place
 *          withLaboratory(blob) -> promise of a blob, the page with the laboratory; throws if that cannot be loaded */

export const PLACE_FOR_LABORATORY = 'live=empty';
const PLACE = 'id="cuvette-live">';
const FILE = '../laboratory.html';

async function laboratory() {
  if (globalThis.cuvetteDocument) return globalThis.cuvetteDocument();
  const response = await fetch(FILE);
  if (!response.ok) throw new Error(`${FILE}: ${response.status}`);
  return response.text();
}

const base64 = (blob) =>
  new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result.split(',')[1]);
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(blob);
  });

export async function withLaboratory(blob) {
  const packed = new Blob([await laboratory()]).stream().pipeThrough(new CompressionStream('deflate'));
  const code = await base64(await new Response(packed).blob());
  const [before, after] = (await blob.text()).split(PLACE, 2);
  return new Blob(after === undefined ? [before] : [before, PLACE, code, after], { type: blob.type });
}
