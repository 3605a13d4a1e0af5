/* The image together with what is drawn over it: rays, normals, angles, ruler, screen, fan.
 * exports:
 *   drawingOver(lab) -> an SVG element in pixels of the full image that needs no style sheet; null if nothing is drawn
 *   paint(lab, blob, drawing) -> promise of a canvas with the image and, unless it is null, the drawing
 *   textOf(drawing) -> the text of an SVG file
 *   dataAddress(blob) -> promise of a data: address
 *   settled(lab) -> promise: what is drawn belongs to the newest scene */

import { styled } from './styled.js';
import { svg } from './ui.js';

const NOT_SAVED = ['object', 'gizmo', 'grab', 'cost', 'compare']; /* layers with handles, and of other images */

export function drawingOver(lab) {
  const { width, height, scale, stage } = lab.view;
  const layers = [...stage.querySelectorAll('.view-layers .layer')].filter(
    (layer) => layer.querySelector(':not(g)') && !NOT_SAVED.some((name) => layer.classList.contains(`layer-${name}`)),
  );
  if (!layers.length) return null;
  return svg(
    'svg',
    { xmlns: 'http://www.w3.org/2000/svg', width, height, viewBox: `0 0 ${width} ${height}` },
    layers.map((layer) => styled(layer, { scale })),
  );
}

export const textOf = (drawing) => new XMLSerializer().serializeToString(drawing);

export const dataAddress = (blob) =>
  new Promise((resolve, reject) => {
    const reader = new FileReader();
    reader.onload = () => resolve(reader.result);
    reader.onerror = () => reject(reader.error);
    reader.readAsDataURL(blob);
  });

/* Lines are drawn with the pixels of the canvas, whatever size the image is shown in. */
export async function paint(lab, blob, drawing) {
  const bitmap = await createImageBitmap(blob, { colorSpaceConversion: 'none' });
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext('2d', { alpha: false });
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  if (drawing) await draw(context, drawing);
  return canvas;
}

async function draw(context, drawing) {
  const image = new Image();
  image.src = `data:image/svg+xml,${encodeURIComponent(textOf(drawing))}`;
  await image.decode();
  context.drawImage(image, 0, 0, context.canvas.width, context.canvas.height);
}

/* --- waiting for what is drawn --- */

const turn = () => new Promise((resolve) => setTimeout(resolve));

/* Two turns without a request: a reply may cause another request. */
export async function settled(lab) {
  const known = () => [lab.scene, lab.state].every((each) => each?.generation >= lab.newestGeneration);
  for (let quiet = 0; quiet < 2;) {
    await turn();
    quiet = known() && lab.change.idle() && lab.view.isDrawn() ? quiet + 1 : 0;
  }
}
