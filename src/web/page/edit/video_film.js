/* Records the frames of a video, each the engine's final image, with what is drawn over it.
 * exports: filmed(lab, frames, recording, {fps, over: BOOL, signal, progress(done)}) -> promise of the file, null after
 *          an abort. frames: of video_frames.js; recording: one of recorder.js */

import { drawingOver, paint, settled } from '../shared/snapshot.js';

/* The final image of the newest scene. A reply may be late: the engine is asked again. */
async function finalImage(lab, signal) {
  for (;;) {
    const generation = lab.newestGeneration;
    try {
      const { blob, headers } = await lab.blob('/api/image.png?wait=1');
      if (Number(headers.get('X-Cuvette-Generation')) >= generation || signal.aborted) return blob;
    } catch (error) {
      if (error.status !== 0 || lab.connected !== 'open' || signal.aborted) throw error;
    }
  }
}

async function record(lab, frames, begin, { over, signal, progress }) {
  let recorder = null;
  try {
    for (let i = 0; i < frames.count && !signal.aborted; i++) {
      await frames.step(i);
      const blob = await finalImage(lab, signal);
      if (over) await settled(lab);
      if (signal.aborted) break;
      const canvas = await paint(lab, blob, over ? drawingOver(lab) : null);
      recorder ??= Object.assign(await begin(canvas), { size: `${canvas.width} x ${canvas.height}` });
      if (recorder.size !== `${canvas.width} x ${canvas.height}`)
        throw new Error('the size of the frames changes; choose another parameter');
      await recorder.add(canvas);
      progress(i + 1);
    }
  } catch (error) {
    recorder?.stop();
    throw error;
  }
  return recorder;
}

export async function filmed(lab, frames, recording, how) {
  const { signal } = how;
  let recorder;
  try {
    recorder = await record(lab, frames, ({ width, height }) => recording.begin({ width, height, fps: how.fps }), how);
  } finally {
    await frames.restore().catch(lab.fail);
  }
  const stop = () => recorder?.stop();
  signal.addEventListener('abort', stop);
  if (signal.aborted) stop();
  try {
    return signal.aborted ? null : await recorder.end();
  } catch (error) {
    if (signal.aborted) return null;
    throw error;
  }
}
