/* Mesh files: films are those of the program, whose importer reads the same files; damaged files give an error,
 * whatever is wrong with them. */

import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { CuvetteError } from '../../src/wasm/api/cuvette.js';
import { ROOT, cuvetteOf, runNative } from './fixture.mjs';

const read = (name) => readFileSync(`${ROOT}tests/data/acts/${name}`);

/* A scene that shows the file, near and from above, with its own materials. */
const scene = (file, shading = 'smooth') => `
render: {width: 64, height: 48, depth: 4}
camera: {position: [3, 2.2, -5], target: [0, 0.3, 0]}
background: {kind: gradient, color: [0.3, 0.5, 0.8], horizon: [0.9, 0.9, 0.8]}
meshes: {thing: {file: ${file}}}
lights: {lamp: {position: [4, 7, -6]}, low: {position: [5, 1, 1]}}
solids:
  ground: {shape: plane, position: [0, -1.2, 0], ambient: 0.2, diffuse: 0.7, checker: 0.7}
  crate: {shape: mesh, mesh: thing, rotation: [0, 20, 0], shading: ${shading}}
`;

/* A prism on a polygon of n corners, with a notch or without. */
function prism(n, notch) {
  const corner = (i) => {
    const radius = notch && i === 1 ? 0.25 : 1;
    return [radius * Math.cos((2 * Math.PI * i) / n), radius * Math.sin((2 * Math.PI * i) / n)];
  };
  const lines = [];
  for (const y of [-0.7, 0.9]) {
    for (let i = 0; i < n; i++) lines.push(`v ${corner(i)[0].toFixed(5)} ${y} ${corner(i)[1].toFixed(5)}`);
  }
  const all = [...Array(n).keys()];
  lines.push(`f ${all.map((i) => i + 1).join(' ')}`);
  lines.push(
    `f ${all
      .map((i) => n + 1 + i)
      .reverse()
      .join(' ')}`,
  );
  for (const i of all) {
    const j = (i + 1) % n;
    lines.push(`f ${i + 1} ${n + i + 1} ${n + j + 1} ${j + 1}`);
  }
  return `${lines.join('\n')}\n`;
}

const OBJ = `# forms
mtllib thing.mtl
o first
v -1 -1 -1 1
v 1.5 -1 -1
v 1 1.25e0 -1 0.5 0.5 0.5
v -1 1 -1
v 0 0.1 -2
vt 0 0
vt 1 0 0
vt 1 1
vn 0 0 -1
vn 0.1 0.2 -1
usemtl grey
f 1/1/1 4/2/1 3/3/1 2/1/1
g group
s 1
usemtl none such
f -5//2 -4//2 \\
 -1//2
l 1 2 3
usemtl grey
f 2/3 3/2 5/1
f 3 4 5
`;
const MTL = `newmtl unused
Kd 1 0 0
newmtl grey
Kd 0.3 0.4 0.5
Ka 0.1 0.1 0.1
Ks 0.4
Ns 30
Ni 1.4
d 0.8
map_Kd chequer.png
`;
const IMAGE = readFileSync(`${ROOT}experiments/scenes/chequer.png`);

const VERTICES = [
  [-1, -1, -1],
  [1, -1, -1],
  [1, 1, -1],
  [-1, 1, -1],
  [-1, -1, 1],
  [1, -1, 1],
  [1, 1.1, 1],
  [-1, 1, 1],
  [9, 9, 9],
];
const FACES = [
  [0, 3, 2, 1],
  [4, 5, 6, 7],
  [0, 1, 5, 4],
  [0, 4, 7],
  [0, 7, 3],
  [2, 3, 7, 6],
  [1, 2, 6, 5],
  [4, 5],
];

function plyHeader(format, type = 'float') {
  return `ply
format ${format} 1.0
comment a box
element vertex ${VERTICES.length}
property ${type} x
property ${type} y
property ${type} z
property float nx
property float ny
property float nz
property uchar red
element face ${FACES.length}
property list uchar int vertex_indices
end_header
`;
}
const normalOf = (v) => v.map((x) => x / 2);

const plyText = () =>
  plyHeader('ascii') +
  VERTICES.map((v) => `${[...v, ...normalOf(v)].join(' ')} 7\n`).join('') +
  FACES.map((f) => `${f.length} ${f.join(' ')}\n`).join('');

function plyBinary(little, type = 'float') {
  const size = VERTICES.length * (type === 'double' ? 37 : 25) + FACES.reduce((sum, f) => sum + 1 + 4 * f.length, 0);
  const view = new DataView(new ArrayBuffer(size));
  let at = 0;
  for (const v of VERTICES) {
    for (const x of v) {
      if (type === 'double') view.setFloat64(at, x, little);
      else view.setFloat32(at, x, little);
      at += type === 'double' ? 8 : 4;
    }
    for (const x of normalOf(v)) view.setFloat32((at += 4) - 4, x, little);
    view.setUint8(at++, 7);
  }
  for (const f of FACES) {
    view.setUint8(at++, f.length);
    for (const i of f) view.setInt32((at += 4) - 4, i, little);
  }
  const header = plyHeader(`binary_${little ? 'little' : 'big'}_endian`, type);
  return Buffer.concat([Buffer.from(header), Buffer.from(view.buffer)]);
}

const STRIPS = `ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element tristrips 1
property list int int vertex_indices
end_header
-1 -1 -1 1 -1 -1 -1 1 -0.9 1 1.1 -1 0 0.1 -2
9 0 2 1 3 -1 4 0 1 2
`;

const TRIANGLES = FACES.filter((f) => f.length > 2).flatMap((f) => f.slice(2).map((c, i) => [f[0], f[i + 1], c]));

const vertexText = (i) => `vertex ${VERTICES[i].join(' ')}\n`;
const facetText = (t) => `facet normal 0 0 0\nouter loop\n${t.map(vertexText).join('')}endloop\nendfacet\n`;
const stlText = () => `solid box\n${TRIANGLES.map(facetText).join('')}endsolid box\n`;

function stlBinary() {
  const view = new DataView(new ArrayBuffer(84 + 50 * TRIANGLES.length));
  view.setUint32(80, TRIANGLES.length, true);
  TRIANGLES.forEach((t, n) => {
    t.forEach((i, k) => {
      VERTICES[i].forEach((x, axis) => view.setFloat32(84 + 50 * n + 12 * (k + 1) + 4 * axis, x, true));
    });
  });
  return Buffer.from(view.buffer);
}

/* glTF, with the image inside: a .glb file, or a .gltf file whose bytes are in the address. */
function gltf(binary) {
  const positions = Buffer.from(new Float32Array(VERTICES.flat()).buffer);
  const corners = Buffer.from(new Uint16Array(TRIANGLES.flat()).buffer);
  const pad = Buffer.alloc(-(positions.length + corners.length) & 3);
  const bytes = Buffer.concat([positions, corners, pad, IMAGE, Buffer.alloc(-IMAGE.length & 3)]);
  const views = [
    { buffer: 0, byteLength: positions.length },
    { buffer: 0, byteOffset: positions.length, byteLength: corners.length },
    { buffer: 0, byteOffset: positions.length + corners.length + pad.length, byteLength: IMAGE.length },
  ];
  const json = {
    asset: { version: '2.0' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, scale: [1, -1, 1], translation: [0, 0.1, 0] }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, TEXCOORD_0: 2 }, indices: 1, material: 0 }] }],
    materials: [{ pbrMetallicRoughness: { baseColorTexture: { index: 0 } }, alphaMode: 'MASK' }],
    textures: [{ source: 0 }],
    images: [{ bufferView: 2, mimeType: 'image/png' }],
    buffers: [{ byteLength: bytes.length }],
    bufferViews: views,
    accessors: [
      { bufferView: 0, componentType: 5126, count: VERTICES.length, type: 'VEC3' },
      { bufferView: 1, componentType: 5123, count: 3 * TRIANGLES.length, type: 'SCALAR' },
      { bufferView: 0, componentType: 5126, count: VERTICES.length, type: 'VEC2' },
    ],
  };
  if (!binary) {
    json.buffers[0].uri = `data:application/octet-stream;base64,${bytes.toString('base64')}`;
    return JSON.stringify(json);
  }
  const text = Buffer.from(JSON.stringify(json).padEnd((JSON.stringify(json).length + 3) & ~3));
  const head = Buffer.alloc(20);
  head.write('glTF', 0);
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(28 + text.length + bytes.length, 8);
  head.writeUInt32LE(text.length, 12);
  head.write('JSON', 16);
  const chunk = Buffer.alloc(8);
  chunk.writeUInt32LE(bytes.length, 0);
  chunk.write('BIN\0', 4);
  return Buffer.concat([head, text, chunk, bytes]);
}

const CASES = {
  'a box with materials': { 'thing.obj': read('faces.obj'), 'faces.mtl': read('faces.mtl') },
  'all forms of OBJ': { 'thing.obj': OBJ, 'thing.mtl': MTL, 'chequer.png': IMAGE },
  'a hexagonal prism': { 'thing.obj': prism(6) },
  'a prism of 17 corners': { 'thing.obj': prism(17) },
  'a prism with a notch': { 'thing.obj': prism(7, true) },
  'concave quadrilaterals': { 'thing.obj': prism(4, true) },
  'PLY as text': { 'thing.ply': plyText() },
  'PLY, little endian': { 'thing.ply': plyBinary(true) },
  'PLY, little endian, doubles': { 'thing.ply': plyBinary(true, 'double') },
  'PLY, big endian': { 'thing.ply': plyBinary(false) },
  'triangle strips of PLY': { 'thing.ply': STRIPS },
  'an OBJ with colours': {
    'thing.obj': 'v -1 0 0 1 0 .2\nv 1 0 0 .3 1 0\nv 0 2 0 0 .4 1\nv 0 -1 1\nf 1 2 3\nf 1 4 2\n',
  },
  'STL as text': { 'thing.stl': stlText() },
  'STL, binary': { 'thing.stl': stlBinary() },
  'glTF with its bytes and image inside': { 'thing.gltf': gltf(false) },
  'binary glTF': { 'thing.glb': gltf(true) },
  'OBJ compressed by gzip': { 'thing.obj.gz': gzipSync(prism(9)) },
  'binary glTF compressed by gzip': { 'thing.glb.gz': gzipSync(gltf(true)) },
  'an OBJ without its library': { 'thing.obj': 'mtllib none.mtl\nusemtl none\n' + prism(5) },
};

let cuvette;
let folder;
before(async () => {
  cuvette = await cuvetteOf('simd128');
  folder = mkdtempSync(join(tmpdir(), 'cuvette-wasm-'));
});
after(() => rmSync(folder, { recursive: true }));

const bytesOf = (text) => (typeof text === 'string' ? new TextEncoder().encode(text) : text);

async function film(files, shading) {
  const name = Object.keys(files).find((file) => /thing/.test(file));
  const all = Object.fromEntries(Object.entries(files).map(([file, text]) => [file, bytesOf(text)]));
  const thing = cuvette.Scene.read(scene(name, shading), { files: all });
  try {
    return await cuvette.engine().render(thing);
  } finally {
    thing.destroy();
  }
}

for (const [what, files] of Object.entries(CASES))
  for (const shading of ['smooth', 'flat'])
    test(`${what}, ${shading}`, async () => {
      const name = Object.keys(files).find((file) => /thing/.test(file));
      for (const [file, text] of Object.entries(files)) writeFileSync(join(folder, file), text);
      writeFileSync(join(folder, 'scene.yaml'), scene(name, shading));
      const { film_hash: hash, rays } = runNative(join(folder, 'scene.yaml'));
      const own = await film(files, shading);
      assert.equal(own.hash, hash);
      assert.equal(own.counters.shadow, rays.shadow);
    });

test('other formats, missing files and bad lines are errors with a remedy', async () => {
  const refused = (files, message) => assert.rejects(film(files), message);
  await refused(
    { 'thing.glb': 'glTF' },
    /thing\.glb: the file is cut short: it has 4 bytes of 12/,
  );
  await refused({ 'thing.obj': 'v 0 0 0\nf 1 2 3\n' }, /thing\.obj:2: a face refers to vertex 2, but the file has 1/);
  await refused({ 'thing.obj': 'v 0 0\n' }, /thing\.obj:1: a vertex has fewer than three numbers/);
  await refused({ 'thing.obj': 'v 0 O 0\n' }, /thing\.obj:1: a vertex has a word that is not a finite number.*: 'O'/);
  await refused({ 'thing.obj': 'vn 0 1 nan\n' }, /thing\.obj:1: a normal has a word that is not a finite number/);
  await refused({ 'thing.obj': 'vn 0 1\n' }, /thing\.obj:1: a normal has fewer than three numbers/);
  await refused({ 'thing.obj': 'v 0 0 0\n' }, /thing\.obj: the file has no triangles/);
  await refused({ 'thing.obj': '' }, /thing\.obj: .*empty/);
  await refused(
    { 'thing.ply': 'ply\nformat ascii 1.0\nelement vertex 3\n' },
    /thing\.ply:4: the header has no end/,
  );
});

/* A list makes vertices of nine bytes take 64 in memory: 2^24 vertices fill half of the module's 2 GiB, and one more
 * doubles them. A module of its own, because memory never shrinks. */
test('a PLY file that does not fit into memory is not called truncated', async () => {
  const count = (1 << 24) + 1;
  const numbers = ['x', 'y', 'z', 'nx', 'ny', 'nz', 's', 't'].map((name) => `property uchar ${name}\n`).join('');
  const properties = `${numbers}property list uchar uchar a\n`;
  const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${count}\n${properties}end_header\n`;
  const own = await cuvetteOf('simd128');
  const read = async (bytes) => {
    const thing = own.Scene.read(scene('thing.ply'), { files: { 'thing.ply': bytes } });
    try {
      await own.engine().render(thing);
    } finally {
      thing.destroy();
    }
  };
  await assert.rejects(read(Buffer.concat([bytesOf(header), Buffer.alloc(9 * count)])), /out of memory/);
  await assert.rejects(read(bytesOf(header)), /the file ends within vertex 1 of 16777217/);
});

/* Numbers in a fixed order. */
function randomOf(seed) {
  let counter = 0;
  return (most) => cuvette.random([seed, 0], [counter++, 0, 0, 0])[0] % most;
}

test('damaged files never end the module', async () => {
  const random = randomOf(25);
  const words = [
    '-1',
    '999999999999',
    'nan',
    '1e999',
    '/',
    '',
    '\\',
    'list',
    '4294967295',
    'f',
    'v',
    '\0',
    '-0',
    '65536',
  ];
  let refused = 0;
  for (const [file, source] of [
    ['thing.obj', OBJ],
    ['thing.mtl', MTL],
    ['thing.obj', prism(9, true)],
    ['thing.ply', plyText()],
    ['thing.ply', plyBinary(true)],
    ['thing.ply', STRIPS],
    ['thing.stl', stlText()],
    ['thing.stl', stlBinary()],
  ])
    for (let i = 0; i < 150; i++) {
      let bytes = Buffer.from(source);
      if (i % 3 === 0) bytes = bytes.subarray(0, random(bytes.length));
      if (i % 3 === 1) for (let k = 0; k < 3; k++) bytes[random(bytes.length)] = random(256);
      if (i % 3 === 2) {
        const at = random(bytes.length);
        bytes = Buffer.concat([
          bytes.subarray(0, at),
          Buffer.from(words[random(words.length)]),
          bytes.subarray(at + 3),
        ]);
      }
      const files = { 'thing.obj': OBJ, 'thing.mtl': MTL, 'chequer.png': IMAGE, [file]: bytes };
      if (/ply|stl/.test(file)) delete files['thing.obj'];
      try {
        const name = file === 'thing.mtl' ? 'thing.obj' : file;
        const thing = cuvette.Scene.read(scene(name), { files });
        try {
          thing.set('render.width', 8);
          thing.set('render.height', 6);
          await cuvette.engine().render(thing);
        } finally {
          thing.destroy();
        }
      } catch (error) {
        assert.ok(error instanceof CuvetteError, `${file}, case ${i}: ${error}`);
        assert.equal(error.status, 2, error.message);
        refused++;
      }
    }
  assert.ok(refused > 200, `${refused} files are refused`);
});
