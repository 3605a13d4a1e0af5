/* QR codes of links (ISO/IEC 18004, model 2): byte mode, versions 1 to 40, error correction L or M.
 * exports:
 *   qrCode(text) -> {version, level, size, dark(x, y)}     the smallest version that holds the text; level M if that
 *                       version holds it with M, else L. null if the text is too long
 *   QR_MOST             the longest text, in bytes of UTF-8 */

/* Error correction words of a block, and the number of blocks, of versions 1 to 40 (table 9). */
const LEVELS = {
  L: {
    bits: 1,
    words: '7 10 15 20 26 18 20 24 30 18 20 24 26 30 22 24 28 30 28 28 28 28 30 30 26 28'.split(' ').map(Number),
    blocks: ('1 1 1 1 1 2 2 2 2 4 4 4 4 4 6 6 6 6 7 8 8 9 9 10 12 12 12 13 14 15 16 17 18 19 19 20 21 ' + '22 24 25')
      .split(' ')
      .map(Number),
    later: 30 /* the words of a block in later versions */,
  },
  M: {
    bits: 0,
    words: '10 16 26 18 24 16 18 22 22 26 30 22 22 24 24 28 28 26 26 26 26'.split(' ').map(Number),
    blocks: (
      '1 1 1 2 2 4 4 4 5 5 5 8 9 9 10 10 11 13 14 16 17 17 18 20 21 23 25 26 28 29 31 33 35 37 38 40 ' + '43 45 47 49'
    )
      .split(' ')
      .map(Number),
    later: 28,
  },
};
const VERSIONS = 40;
const BYTE_MODE = 4;
const PADS = [0xec, 0x11];

/* --- the capacity of a version --- */

const sizeOf = (version) => 17 + 4 * version;

function alignmentsOf(version) {
  if (version === 1) return [];
  const count = Math.floor(version / 7) + 2;
  const step = 2 * Math.floor((8 * version + 3 * count + 5) / (4 * count - 4));
  const last = sizeOf(version) - 7;
  return [6, ...Array.from({ length: count - 1 }, (_, i) => last - step * (count - 2 - i))];
}

/* All codewords: the modules outside the patterns, in bytes. */
function wordsOf(version) {
  const count = alignmentsOf(version).length;
  const alignment = count ? (25 * count - 10) * count - 55 : 0;
  return Math.floor(((16 * version + 128) * version + 64 - alignment - (version < 7 ? 0 : 36)) / 8);
}

const correctionOf = (version, level) => LEVELS[level].words[version - 1] ?? LEVELS[level].later;
const blocksOf = (version, level) => LEVELS[level].blocks[version - 1];
const dataWordsOf = (version, level) => wordsOf(version) - correctionOf(version, level) * blocksOf(version, level);
const lengthBits = (version) => (version < 10 ? 8 : 16);
const capacity = (version, level) => Math.floor((8 * dataWordsOf(version, level) - 4 - lengthBits(version)) / 8);

export const QR_MOST = capacity(VERSIONS, 'L');

/* --- data and error correction: Reed-Solomon over GF(256), x^8 + x^4 + x^3 + x^2 + 1 --- */

function multiply(x, y) {
  let product = 0;
  for (let bit = 7; bit >= 0; bit--) {
    product = (product << 1) ^ ((product >> 7) * 0x11d);
    product ^= ((y >> bit) & 1) * x;
  }
  return product;
}

/* The product of x - 2^i for all i below the degree, without its first coefficient, 1. */
function generatorOf(degree) {
  const factors = Array(degree).fill(0);
  factors[degree - 1] = 1;
  let root = 1;
  for (let i = 0; i < degree; i++) {
    for (let k = 0; k < degree; k++) factors[k] = multiply(factors[k], root) ^ (factors[k + 1] ?? 0);
    root = multiply(root, 2);
  }
  return factors;
}

function remainderOf(data, generator) {
  const rest = Array(generator.length).fill(0);
  for (const word of data) {
    const factor = word ^ rest.shift();
    rest.push(0);
    generator.forEach((each, i) => {
      rest[i] ^= multiply(each, factor);
    });
  }
  return rest;
}

function dataOf(bytes, version, level) {
  const bits = [];
  const write = (value, count) => {
    for (let bit = count - 1; bit >= 0; bit--) bits.push((value >> bit) & 1);
  };
  const room = dataWordsOf(version, level);
  write(BYTE_MODE, 4);
  write(bytes.length, lengthBits(version));
  for (const byte of bytes) write(byte, 8);
  write(0, Math.min(4, 8 * room - bits.length));
  while (bits.length % 8) bits.push(0);
  const words = Array.from({ length: bits.length / 8 }, (_, i) =>
    bits.slice(8 * i, 8 * i + 8).reduce((value, bit) => 2 * value + bit, 0),
  );
  for (let i = 0; words.length < room; i++) words.push(PADS[i % 2]);
  return words;
}

/* Blocks with their error correction, interleaved; the last blocks may have one data word more. */
function interleaved(data, version, level) {
  const count = blocksOf(version, level);
  const short = Math.floor(data.length / count);
  const longer = data.length % count;
  const generator = generatorOf(correctionOf(version, level));
  let at = 0;
  const blocks = Array.from({ length: count }, (_, i) => data.slice(at, (at += short + (i < count - longer ? 0 : 1))));
  const checks = blocks.map((block) => remainderOf(block, generator));
  const across = (lists, length) =>
    Array.from({ length }, (_, i) => lists.flatMap((list) => (i < list.length ? [list[i]] : []))).flat();
  return [...across(blocks, short + 1), ...across(checks, generator.length)];
}

/* --- the modules --- */

function createGrid(version) {
  const size = sizeOf(version);
  const dark = new Uint8Array(size * size);
  const fixed = new Uint8Array(size * size);
  const grid = { size, dark, fixed, put };
  const alignments = alignmentsOf(version);
  for (let i = 0; i < size; i++) {
    put(6, i, i % 2 === 0);
    put(i, 6, i % 2 === 0);
  }
  for (const [x, y] of [
    [3, 3],
    [size - 4, 3],
    [3, size - 4],
  ])
    square(x, y, 4, (ring) => ring !== 2 && ring !== 4);
  const end = alignments.length - 1;
  alignments.forEach((x, i) =>
    alignments.forEach((y, k) => {
      const finder = (i === 0 && (k === 0 || k === end)) || (i === end && k === 0);
      if (!finder) square(x, y, 2, (ring) => ring !== 1);
    }),
  );
  putFormat(grid, 'L', 0); /* reserves its place */
  if (version >= 7) putVersion(grid, version);
  return grid;

  function put(x, y, on) {
    dark[y * size + x] = on ? 1 : 0;
    fixed[y * size + x] = 1;
  }

  function square(x, y, reach, isDark) {
    for (let dy = -reach; dy <= reach; dy++)
      for (let dx = -reach; dx <= reach; dx++)
        if (x + dx >= 0 && y + dy >= 0 && x + dx < size && y + dy < size)
          put(x + dx, y + dy, isDark(Math.max(Math.abs(dx), Math.abs(dy))));
  }
}

/* A value with the remainder of its division by a generator polynomial: a BCH code. */
function withRemainder(value, generator, bits) {
  let rest = value;
  for (let i = 0; i < bits; i++) rest = (rest << 1) ^ ((rest >> (bits - 1)) * generator);
  return (value << bits) | rest;
}

const FORMAT_MASK = 0x5412;

function putFormat({ size, put }, level, mask) {
  const format = withRemainder((LEVELS[level].bits << 3) | mask, 0x537, 10) ^ FORMAT_MASK;
  for (let i = 0; i < 15; i++) {
    const on = (format >> i) & 1;
    if (i < 6) put(8, i, on);
    else if (i < 8) put(8, i + 1, on);
    else put(i === 8 ? 7 : 14 - i, 8, on);
    if (i < 8) put(size - 1 - i, 8, on);
    else put(8, size - 15 + i, on);
  }
  put(8, size - 8, true);
}

function putVersion({ size, put }, version) {
  const words = withRemainder(version, 0x1f25, 12);
  for (let i = 0; i < 18; i++) {
    const [a, b] = [size - 11 + (i % 3), Math.floor(i / 3)];
    put(a, b, (words >> i) & 1);
    put(b, a, (words >> i) & 1);
  }
}

/* Pairs of columns from the right, upwards and downwards in turn; the timing column is skipped. */
function putWords({ size, dark, fixed }, words) {
  let bit = 0;
  for (let right = size - 1; right > 0; right -= 2) {
    if (right === 6) right = 5;
    const upwards = ((right + 1) & 2) === 0;
    for (let i = 0; i < size; i++)
      for (const x of [right, right - 1]) {
        const at = (upwards ? size - 1 - i : i) * size + x;
        if (fixed[at]) continue;
        dark[at] = ((words[bit >> 3] ?? 0) >> (7 - (bit & 7))) & 1;
        bit += 1;
      }
  }
}

/* --- masks: the one with the least penalty --- */

const MASKS = [
  (x, y) => (x + y) % 2,
  (x, y) => y % 2,
  (x) => x % 3,
  (x, y) => (x + y) % 3,
  (x, y) => (Math.floor(x / 3) + Math.floor(y / 2)) % 2,
  (x, y) => ((x * y) % 2) + ((x * y) % 3),
  (x, y) => (((x * y) % 2) + ((x * y) % 3)) % 2,
  (x, y) => (((x + y) % 2) + ((x * y) % 3)) % 2,
];

function masked({ size, dark, fixed }, mask) {
  return dark.map((on, at) => on ^ (!fixed[at] && MASKS[mask](at % size, Math.floor(at / size)) === 0 ? 1 : 0));
}

/* Section 7.8.3.1: runs of one colour, blocks of it, patterns that look like a finder, and the balance of colours. */
function penaltyOf(dark, size) {
  let sum = 0;
  const lines = Array.from({ length: size }, (_, i) => [
    dark.subarray(i * size, (i + 1) * size),
    Uint8Array.from({ length: size }, (__, k) => dark[k * size + i]),
  ]).flat();
  for (const line of lines) {
    const text = line.join('');
    for (const [run] of text.matchAll(/0{5,}|1{5,}/g)) sum += run.length - 2;
    for (const _ of text.matchAll(/(?=00001011101|10111010000)/g)) sum += 40;
  }
  for (let at = 0; at < size * (size - 1); at++)
    if (at % size < size - 1 && dark[at] + dark[at + 1] + dark[at + size] + dark[at + size + 1] === 4) sum += 3;
    else if (at % size < size - 1 && !(dark[at] | dark[at + 1] | dark[at + size] | dark[at + size + 1])) sum += 3;
  const fraction = dark.reduce((count, on) => count + on, 0) / dark.length;
  return sum + 10 * Math.floor(Math.abs(fraction - 0.5) * 20);
}

export function qrCode(text) {
  const bytes = new TextEncoder().encode(text);
  let version = 1;
  while (version <= VERSIONS && capacity(version, 'L') < bytes.length) version += 1;
  if (version > VERSIONS) return null;
  const level = capacity(version, 'M') < bytes.length ? 'L' : 'M';
  const grid = createGrid(version);
  putWords(grid, interleaved(dataOf(bytes, version, level), version, level));
  const tried = MASKS.map((_, mask) => {
    putFormat(grid, level, mask);
    const dark = masked(grid, mask);
    return { dark, mask, penalty: penaltyOf(dark, grid.size) };
  });
  const { dark, mask } = tried.reduce((best, each) => (each.penalty < best.penalty ? each : best));
  return { version, level, mask, size: grid.size, dark: (x, y) => dark[y * grid.size + x] === 1 };
}
