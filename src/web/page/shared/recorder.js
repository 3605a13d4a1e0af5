/* Recorders of videos in the browser: frames in, a file out.
 *
 * exports:
 *   recordings() -> the possible ones: [{name, ending, exact: BOOL, begin({width, height, fps}) -> promise of a
 *                   recorder}]
 *   recorder.add(canvas) -> promise: the frame is taken, the canvas may change
 *   recorder.end() -> promise of the file, a Blob
 *   recorder.stop()      without a file
 *
 * With a VideoEncoder (WebCodecs) the frames have exact times, and are encoded as fast as they come. MediaRecorder
 * takes the time of a frame from the clock: the frames are kept, compressed, and played to it at the end. */

import { webm } from './webm.js';

/* As many bits as keep lines and edges sharp. */
const bitsPerS = ({ width, height, fps }) => Math.round(Math.min(60e6, Math.max(2e6, 0.25 * width * height * fps)));

/* VP9 of 8 bits and 4:2:0; VP8 where a browser lacks its encoder. */
const CODECS = [
  { codec: 'vp09.00.51.08', name: 'V_VP9' },
  { codec: 'vp8', name: 'V_VP8' },
];
const KEY_S = 2; /* a player can begin at each key frame */
const WAITING_MAX = 4; /* frames in the encoder, which hold a bitmap each */

const MP4 = 'video/mp4;codecs=avc1.42E01E';
const plays = (type) => globalThis.MediaRecorder?.isTypeSupported(type);

export function recordings() {
  const list = [];
  if (globalThis.VideoEncoder) list.push({ name: 'WebM', ending: 'webm', exact: true, begin: encode });
  else if (plays('video/webm'))
    list.push({ name: 'WebM', ending: 'webm', exact: false, begin: (size) => play(size, 'video/webm') });
  if (plays(MP4)) list.push({ name: 'MP4', ending: 'mp4', exact: false, begin: (size) => play(size, MP4) });
  return list;
}

/* The first codec that the browser has; the last is tried without a promise. */
async function configured({ width, height, fps }) {
  const bitrate = bitsPerS({ width, height, fps });
  for (const { codec, name } of CODECS) {
    const config = { codec, width, height, bitrate, framerate: fps, latencyMode: 'quality' }; /* drops no frame */
    if (codec === CODECS.at(-1).codec || (await VideoEncoder.isConfigSupported(config)).supported)
      return { name, config };
  }
  return null;
}

async function encode({ width, height, fps }) {
  const { name, config } = await configured({ width, height, fps });
  const frames = [];
  let colour = null;
  const keys = Math.max(1, Math.round(KEY_S * fps));
  let failure = null;
  let taken = 0;
  const encoder = new VideoEncoder({
    output(chunk, about) {
      colour ??= about?.decoderConfig?.colorSpace ?? null;
      const bytes = new Uint8Array(chunk.byteLength);
      chunk.copyTo(bytes);
      frames.push({ key: chunk.type === 'key', bytes });
    },
    error(error) {
      failure = error;
    },
  });
  encoder.configure(config);
  return {
    async add(canvas) {
      while (encoder.encodeQueueSize > WAITING_MAX && !failure) await new Promise((resolve) => setTimeout(resolve, 5));
      if (failure) throw failure;
      const frame = new VideoFrame(canvas, {
        timestamp: Math.round((1e6 * taken) / fps),
        duration: Math.round(1e6 / fps),
      });
      encoder.encode(frame, { keyFrame: taken % keys === 0 });
      frame.close();
      taken++;
    },
    async end() {
      await encoder.flush();
      if (failure) throw failure;
      encoder.close();
      return webm({ width, height, fps, codec: name, colour, frames });
    },
    stop() {
      if (encoder.state !== 'closed') encoder.close();
    },
  };
}

async function play({ width, height, fps }, type) {
  const kept = [];
  let stopped = false;
  return {
    async add(canvas) {
      kept.push(await canvas.convertToBlob());
    },
    async end() {
      const canvas = Object.assign(document.createElement('canvas'), { width, height });
      const context = canvas.getContext('2d', { alpha: false });
      const stream = canvas.captureStream(0);
      const [film] = stream.getVideoTracks();
      const parts = [];
      const recorder = new MediaRecorder(stream, {
        mimeType: type,
        videoBitsPerSecond: bitsPerS({ width, height, fps }),
      });
      recorder.ondataavailable = ({ data }) => parts.push(data);
      const ended = new Promise((resolve, reject) => {
        recorder.onstop = resolve;
        recorder.onerror = ({ error }) => reject(error ?? new Error('the browser cannot record the video'));
      });
      recorder.start();
      const began = performance.now();
      for (let i = 0; i <= kept.length && !stopped; i++) {
        const bitmap = await createImageBitmap(kept[Math.min(i, kept.length - 1)]);
        await new Promise((resolve) => setTimeout(resolve, began + (1000 * i) / fps - performance.now()));
        context.drawImage(bitmap, 0, 0);
        bitmap.close();
        if (i < kept.length) film.requestFrame();
      }
      recorder.stop();
      film.stop();
      await ended;
      return new Blob(parts, { type });
    },
    stop() {
      stopped = true;
    },
  };
}
