/* The calls of the API that a worker answers, by the kind of object.
 *
 * exports: CALLS */

const SCENE =
  'clone set get parameters text hints check names addLight addMaterial addSolid addMesh remove rename query trace ' +
  'fan realism curve lens motion';

export const CALLS = {
  Cuvette: ['random', 'engine', 'readScene', 'createScene', 'facts'],
  Scene: SCENE.split(' '),
  Query: ['cameraRay', 'nearest', 'medium', 'trace', 'fan'],
  Motion: ['names', 'state', 'advance', 'pick', 'grab', 'move', 'release'],
  Engine: ['render', 'cancel'],
};
