/* Slime: to come. exports: panel */

import {empty} from './ui.js';

export const panel = {
  id: 'slime', title: 'Slime',
  create(root) {
    root.append(empty('Nothing here yet.'));
  },
};
