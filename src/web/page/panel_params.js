/* The parameters of the scene: to come. exports: panel */

import {empty} from './ui.js';

export const panel = {
  id: 'params', title: 'Parameters',
  create(root) {
    root.append(empty('Nothing here yet.'));
  },
};
