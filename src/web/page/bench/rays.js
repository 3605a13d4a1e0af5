/* The rays of the scene's beams, in world space: requested again when the scene changes, not when the camera moves.
 *
 * exports: segmentsOf(beam) -> the segments of a beam of /api/beams
 *          createBenchRays(lab) -> {segments, error, on(f)}
 *   segments: [{beam, ray: {number, lambda_nm, power, displayed}, tree, one, line, power, css}] in the order of the
 *   reply; one: a ray of ray_tree.js, and its line; power: at its start */

import { mean } from '../shared/vectors.js';
import { buildTree } from './ray_tree.js';

export function createBenchRays(lab) {
  const listeners = new Set();
  const rays = { segments: [], error: null, on: (listener) => listeners.add(listener) };
  let traced = null; /* the version of the scene */
  let asking = false;

  lab.on('scene', follow);
  lab.on('restarted', () => {
    traced = null;
  });
  lab.view.behind(() => asking);
  if (lab.scene) follow();
  return rays;

  /* Sends one request at a time; a change during a request causes another one. */
  async function follow() {
    if (asking || !lab.scene) return;
    if (lab.scene.version === traced) return;
    asking = true;
    traced = lab.scene.version;
    try {
      const some = lab.scene.objects.some((object) => object.kind === 'beam');
      rays.segments = some ? (await lab.get('/api/beams')).beams.flatMap(segmentsOf) : [];
      rays.error = null;
    } catch (error) {
      Object.assign(rays, { segments: [], error });
    }
    asking = false;
    for (const listener of listeners) listener();
    follow();
  }
}

export function segmentsOf({ name, rays }) {
  return rays.flatMap((ray) => {
    const tree = buildTree({ root: ray.root });
    const css = `rgb(${ray.displayed.join(' ')})`;
    return tree.rays.map((one) => ({
      beam: name,
      ray,
      tree,
      one,
      line: one.line,
      power: ray.power * mean(one.node.throughput),
      css,
    }));
  });
}
