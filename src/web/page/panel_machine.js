/* Machine: to come. exports: panel */

import {empty} from './ui.js';

export const panel = {
  id: 'machine', title: 'Machine',
  create(root) {
    root.append(empty('Nothing here yet.'));
  },
};
