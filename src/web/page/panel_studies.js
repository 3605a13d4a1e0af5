/* Studies: to come. exports: panel */

import {empty} from './ui.js';

export const panel = {
  id: 'studies', title: 'Studies', wide: true,
  create(root) {
    root.append(empty('Nothing here yet.'));
  },
};
