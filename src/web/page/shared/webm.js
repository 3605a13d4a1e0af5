/* Writes WebM files with one video track and exact times of frames: RFC 8794 (EBML), RFC 9559 (Matroska).
 * exports: webm({width, height, fps, codec: 'V_VP8' | 'V_VP9', colour, frames: [{key: BOOL, bytes}]}) -> Blob
 *   colour: a VideoColorSpace of WebCodecs, or null. Without it players guess, and show other colours */

const MS = 1e6; /* of the time scale, in ns: times are whole milliseconds */
const CLUSTER_MS = 30000; /* times in a cluster have 16 bits with a sign */

/* The bytes of an unsigned integer, the highest first. */
function whole(value, size = 0) {
  const bytes = [];
  for (let rest = value; rest > 0 || bytes.length < (size || 1); rest = Math.floor(rest / 256))
    bytes.unshift(rest % 256);
  return new Uint8Array(bytes);
}

/* A size, always of eight bytes. */
function sizeOf(length) {
  const bytes = whole(length, 8);
  bytes[0] = 1;
  return bytes;
}

const text = (words) => new TextEncoder().encode(words);

function real(value) {
  const bytes = new Uint8Array(8);
  new DataView(bytes.buffer).setFloat64(0, value);
  return bytes;
}

const lengthOf = (parts) => parts.reduce((sum, part) => sum + (part.byteLength ?? lengthOf(part)), 0);

/* An element: a list of its bytes. content: bytes and elements. */
const item = (id, ...content) => [whole(id), sizeOf(lengthOf(content)), ...content.flat()];

const HEAD = item(
  0x1a45dfa3,
  item(0x4286, whole(1)) /* version and largest sizes of EBML */,
  item(0x42f7, whole(1)),
  item(0x42f2, whole(4)),
  item(0x42f3, whole(8)),
  item(0x4282, text('webm')),
  item(0x4287, whole(2)),
  item(0x4285, whole(2)),
);

const info = (ms) =>
  item(
    0x1549a966,
    item(0x2ad7b1, whole(MS)),
    item(0x4489, real(ms)),
    item(0x4d80, text('Cuvette')) /* who wrote the file, and who the frames */,
    item(0x5741, text('Cuvette')),
  );

/* Numbers of ITU-T H.273. */
const MATRIX = { rgb: 0, bt709: 1, bt470bg: 5, smpte170m: 6, 'bt2020-ncl': 9 };
const TRANSFER = { bt709: 1, smpte170m: 6, linear: 8, 'iec61966-2-1': 13, pq: 16, hlg: 18 };
const PRIMARIES = { bt709: 1, bt470bg: 5, smpte170m: 6, bt2020: 9, smpte432: 12 };
const UNKNOWN = 2;

function colours(colour) {
  if (!colour) return [];
  return item(
    0x55b0,
    item(0x55b1, whole(MATRIX[colour.matrix] ?? UNKNOWN)),
    item(0x55b9, whole(colour.fullRange ? 2 : 1)),
    item(0x55ba, whole(TRANSFER[colour.transfer] ?? UNKNOWN)),
    item(0x55bb, whole(PRIMARIES[colour.primaries] ?? UNKNOWN)),
  );
}

const track = ({ width, height, fps, codec, colour }) =>
  item(
    0x1654ae6b,
    item(
      0xae,
      item(0xd7, whole(1)) /* number */,
      item(0x73c5, whole(1)) /* identity */,
      item(0x9c, whole(0)) /* without lacing */,
      item(0x83, whole(1)) /* video */,
      item(0x86, text(codec)),
      item(0x23e383, whole(Math.round(1e9 / fps))) /* ns of a frame */,
      item(0xe0, item(0xb0, whole(width)), item(0xba, whole(height)), colours(colour)),
    ),
  );

/* A frame of a cluster: track, time from the cluster's, and whether it needs no other frame. */
function block({ key, bytes }, ms) {
  const head = new Uint8Array([0x81, 0, 0, key ? 0x80 : 0]);
  new DataView(head.buffer).setInt16(1, ms);
  return item(0xa3, head, bytes);
}

/* A cluster begins with a key frame, so that a player can begin there. */
function clusters(frames, fps) {
  const list = [];
  frames.forEach((frame, i) => {
    const ms = Math.round((1000 * i) / fps);
    if (!list.length || (frame.key && ms > list.at(-1).ms) || ms - list.at(-1).ms > CLUSTER_MS)
      list.push({ ms, blocks: [] });
    list.at(-1).blocks.push(block(frame, ms - list.at(-1).ms));
  });
  return list.map(({ ms, blocks }) => ({ ms, bytes: item(0x1f43b675, item(0xe7, whole(ms)), ...blocks) }));
}

/* Where each cluster begins, in bytes from the start of the segment's content. */
function cues(list, before) {
  let at = before;
  const points = list.map(({ ms, bytes }) => {
    const place = item(0xb7, item(0xf7, whole(1)), item(0xf1, whole(at, 8)));
    at += lengthOf(bytes);
    return item(0xbb, item(0xb3, whole(ms, 8)), place);
  });
  return item(0x1c53bb6b, ...points);
}

export function webm(video) {
  const { frames, fps } = video;
  const start = [...info((1000 * frames.length) / fps), ...track(video)];
  const list = clusters(frames, fps);
  const index = cues(list, lengthOf(start) + lengthOf(cues(list, 0))); /* its length does not depend on the places */
  const content = [...start, ...index, ...list.flatMap(({ bytes }) => bytes)];
  return new Blob([...HEAD, whole(0x18538067), sizeOf(lengthOf(content)), ...content], { type: 'video/webm' });
}
