/* What changes from frame to frame of a video.
 * exports: videoFrames(lab, what) -> {count, step(i) -> promise, restore() -> promise}
 *   what: {kind: 'sweep', row, from, to, count}, {kind: 'orbit', degrees, count} or {kind: 'motion', count, fps}
 *   step(i): shows the scene of a frame; restore: the scene and the view as before the first frame
 *   slimes(lab) -> the names of the scene's slimes */

import { gesture } from '../shared/ui.js';
import { goView } from '../view/camera_moves.js';

export const slimes = (lab) =>
  (lab.scene?.params ?? [])
    .filter(({ path, value }) => path.endsWith('.generate') && value === 'slime')
    .map(({ path }) => path.slice(0, path.lastIndexOf('.')));

export function videoFrames(lab, what) {
  const name = gesture('video');
  if (what.kind === 'orbit') return orbit(lab, what, name);
  if (what.kind === 'sweep') return changes(lab, what.count, name, (i) => ({ [what.row.path]: swept(what, i) }));
  const paths = slimes(lab).map((slime) => `${slime}.time_s`);
  return changes(
    lab,
    what.count,
    name,
    (i) => Object.fromEntries(paths.map((path) => [path, i / what.fps])),
    () => lab.post('/api/slime', { do: 'off' }),
  );
}

function swept({ row, from, to, count }, i) {
  const value = i === count - 1 ? to : from + ((to - from) * i) / (count - 1);
  return row.type === 'integer' ? Math.round(value) : value;
}

/* All changes are one step of undo, which is taken back at the end. */
function changes(lab, count, name, valuesAt, begin = () => undefined) {
  let generation = 0;
  return {
    count,
    async step(i) {
      if (i === 0) {
        await begin();
        generation = lab.newestGeneration;
      }
      await lab.set(valuesAt(i), name);
    },
    async restore() {
      if (generation && lab.newestGeneration > generation) await lab.change('/api/undo', {});
    },
  };
}

/* A whole turn ends one step before its first frame, so that it can be repeated without a jump. */
function orbit(lab, { degrees, count }, name) {
  const step = degrees / (degrees % 360 === 0 ? count : count - 1);
  let moved = false;
  return {
    count,
    async step(i) {
      if (i === 0) return;
      await lab.change('/api/camera', { orbit: [step, 0] }, { gesture: name });
      moved = true;
    },
    async restore() {
      if (moved) await goView(lab, 'back');
    },
  };
}
