/* The scene in a PNG file (cuvette-scene(5), SHARED SCENES).
 * exports:
 *   codeOfPng(bytes) -> the code of the scene, as in links; null if there is none
 *   withScene(bytes, from) -> a PNG with the scene of another one, as parts of a Blob */

const KEYWORD = 'Cuvette scene';
const AFTER_HEAD = 8 + 25; /* the signature and the chunk IHDR */

const word = (bytes) => String.fromCharCode(...bytes);

/* The chunk of the scene: length, type, data, checksum; null if there is none. */
function sceneChunk(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  for (let at = 8; at + 12 <= bytes.length; at += 12 + view.getUint32(at)) {
    const chunk = bytes.subarray(at, at + 12 + view.getUint32(at));
    if (word(chunk.subarray(4, 8)) === 'iTXt' && word(chunk.subarray(8, 8 + KEYWORD.length)) === KEYWORD) return chunk;
  }
  return null;
}

/* iTXt (PNG specification, 11.3.3): keyword, 0, compressed, method, language, 0, translated keyword, 0, text. */
export function codeOfPng(bytes) {
  const chunk = sceneChunk(bytes);
  if (!chunk) return null;
  const data = chunk.subarray(8, -4);
  const rest = data.subarray(KEYWORD.length + 3);
  const text = rest.subarray(rest.indexOf(0, rest.indexOf(0) + 1) + 1);
  return data[KEYWORD.length + 1] === 1 ? base64url(text) : null;
}

function base64url(bytes) {
  let text = '';
  for (const byte of bytes) text += String.fromCharCode(byte);
  return btoa(text).replace(/\+/g, '-').replace(/\//g, '_').replace(/=+$/, '');
}

export function withScene(bytes, from) {
  const chunk = sceneChunk(from);
  return chunk ? [bytes.subarray(0, AFTER_HEAD), chunk, bytes.subarray(AFTER_HEAD)] : [bytes];
}
