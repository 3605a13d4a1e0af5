// Decodes PNGs of the program (8 bits per channel, RGB or RGBA, not interlaced) without the browser's decoder, which is
// under test.
import { inflateSync } from 'node:zlib';

function paeth(left, above, corner) {
  const guess = left + above - corner;
  const [l, a, c] = [Math.abs(guess - left), Math.abs(guess - above), Math.abs(guess - corner)];
  return l <= a && l <= c ? left : a <= c ? above : corner;
}

const predictions = [() => 0, (left) => left, (left, above) => above, (left, above) => (left + above) >> 1, paeth];

/** {width, height, data}: RGBA, one byte per channel, rows from the top as in ImageData. */
export function readPng(bytes) {
  const file = Buffer.from(bytes);
  if (file.readUInt32BE(0) !== 0x89504e47) throw new Error('the file is not a PNG');
  let head = null;
  const packed = [];
  for (let at = 8; at < file.length; at += 12 + file.readUInt32BE(at)) {
    const type = file.toString('latin1', at + 4, at + 8);
    const body = file.subarray(at + 8, at + 8 + file.readUInt32BE(at));
    if (type === 'IHDR')
      head = {
        width: body.readUInt32BE(0),
        height: body.readUInt32BE(4),
        bits: body[8],
        kind: body[9],
        interlaced: body[12],
      };
    if (type === 'IDAT') packed.push(body);
  }
  const channels = { 2: 3, 6: 4 }[head.kind];
  if (head.bits !== 8 || !channels || head.interlaced)
    throw new Error('unsupported PNG: only 8-bit RGB or RGBA without interlace');
  const { width, height } = head;
  const raw = inflateSync(Buffer.concat(packed));
  const data = new Uint8ClampedArray(width * height * 4).fill(255);
  const size = width * channels;
  let above = new Uint8Array(size);
  for (let y = 0; y < height; y++) {
    const predict = predictions[raw[y * (size + 1)]];
    const row = new Uint8Array(size);
    for (let i = 0; i < size; i++) {
      const left = i < channels ? 0 : row[i - channels];
      const corner = i < channels ? 0 : above[i - channels];
      row[i] = raw[y * (size + 1) + 1 + i] + predict(left, above[i], corner);
    }
    for (let x = 0; x < width; x++)
      for (let c = 0; c < channels; c++) data[(y * width + x) * 4 + c] = row[x * channels + c];
    above = row;
  }
  return { width, height, data };
}
