/* Objects: to come. exports: panel */

import {empty} from './ui.js';

export const panel = {
  id: 'edit', title: 'Objects',
  create(root) {
    root.append(empty('Nothing here yet.'));
  },
};
