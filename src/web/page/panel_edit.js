/* The panel Objects: scene files, objects to add, the list of all objects, and the selected one. exports: panel. The
 * tool Object selects and moves objects in the image. */

import { button, element, group } from './ui.js';
import { createChoice } from './object_choice.js';
import { createDetails } from './object_details.js';
import { createFiles } from './scene_files.js';
import { createList } from './object_list.js';
import { createWhole } from './object_whole.js';
import { createMark } from './object_mark.js';
import { objectTool } from './object_tool.js';

let choice = null;
let files = null;

function start(lab) {
  if (choice) return;
  choice = createChoice(lab);
  files = createFiles(lab, choice);
  lab.save = files.save;
  const mark = createMark(lab, choice);
  objectTool(lab, choice, mark);
}

function fileButtons() {
  return element(
    'div',
    { class: 'buttons', role: 'group', 'aria-label': 'Scene file' },
    button('Open …', files.open, { icon: 'folder' }),
    button('New', files.fresh, { icon: 'plus' }),
    button('Save', files.save, { icon: 'save', title: 'Save (Ctrl S)' }),
    button('Save as …', () => files.saveAs()),
  );
}

/* The shapes are known with the first scene. */
function shapeButtons(lab) {
  const node = element('div', { class: 'buttons', role: 'group', 'aria-label': 'Add a solid' });
  const fill = () => {
    if (node.firstChild || !lab.scene) return;
    for (const { shape, meaning } of lab.scene.shapes) {
      const label = shape[0].toUpperCase() + shape.slice(1);
      node.append(button(label, () => choice.add({ kind: 'solid', shape }), { small: true, title: meaning }));
    }
  };
  lab.on('scene', fill);
  fill();
  return node;
}

function addButtons(lab) {
  const small = (label, act, icon) => button(label, act, { small: true, icon });
  return group(
    'Add',
    { id: 'edit.add' },
    shapeButtons(lab),
    element(
      'div',
      { class: 'buttons', role: 'group', 'aria-label': 'Add other objects' },
      small('Light', () => choice.add({ kind: 'light' }), 'light'),
      small('Beam', () => choice.add({ kind: 'beam' }), 'beam'),
      small('Material', () => choice.add({ kind: 'material' })),
      small('Slime', () => choice.add({ kind: 'slime' }), 'hand'),
      small('Model …', () => files.addFile('model', 'Add a model'), 'cube'),
      small('Texture …', () => files.addFile('texture', 'Add a texture'), 'image'),
      small('Sky …', files.pickSky, 'image'),
    ),
  );
}

function create(root, lab) {
  start(lab);
  root.append(
    fileButtons(),
    addButtons(lab),
    createList(lab, choice).node,
    createDetails(lab, choice, files).node,
    createWhole(lab),
  );
}

export const panel = { id: 'edit', title: 'Objects', css: 'panel_edit.css', start, create };
