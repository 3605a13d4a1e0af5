/* The tool Light: one handle per light at its position in the image.
 * exports: lightTool(lab) */

import { createWheelZoom } from './camera_moves.js';
import { createPointHandles } from './point_handles.js';

export function lightTool(lab) {
  const handles = createPointHandles(lab, { list, symbol: 'light', what: 'light' });
  lab.view.tool('light', {
    label: 'Light',
    icon: 'light',
    order: 20,
    cursor: 'default',
    hint: 'Drag a light; with Shift: nearer and farther',
    wheel: createWheelZoom(lab),
    chosen: handles.show,
    dropped: handles.hide,
  });

  function list() {
    return (lab.scene?.objects || [])
      .filter((object) => object.kind === 'light' && lab.param(`${object.name}.position`))
      .map(({ name }) => ({ path: `${name}.position`, name }));
  }
}
