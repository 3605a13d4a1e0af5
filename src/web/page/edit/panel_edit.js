/* The panel Objects: scene files, the palette of the bench, other objects to add, the list of all objects, and the
 * selected one. exports: panel. The tool Object selects and moves objects in the image. */

import { translated } from '../shared/language.js';
import { share } from '../shared/share.js';
import { button, choice as choiceOf, element, group } from '../shared/ui.js';
import { createChoice } from './object_choice.js';
import { createDetails, presetChoices, presetValues } from './object_details.js';
import { createList } from './object_list.js';
import { createScenePads } from './object_pads.js';
import { createPalette } from './palette.js';
import { createMark, objectTool } from './object_tool.js';
import { createFiles } from './scene_files.js';

let choice = null;
let files = null;

function start(lab) {
  if (choice) return;
  choice = createChoice(lab);
  files = createFiles(lab, choice);
  lab.save = files.save;
  lab.choice = choice;
  const mark = createMark(lab, choice);
  objectTool(lab, choice, mark);
}

function fileButtons(lab) {
  return element(
    'div',
    { class: 'buttons', role: 'group', 'aria-label': 'Scene file' },
    button('Open …', files.open, { icon: 'folder' }),
    button('New', files.fresh, { icon: 'plus' }),
    button('Save', files.save, { icon: 'save', title: 'Save (Ctrl S)' }),
    button('Save as …', () => files.saveAs()),
    button('Share …', () => share(lab), { title: 'Share the scene as a link, an image or an HTML file' }),
  );
}

/* The material of a new solid; the choices follow the materials of the scene. */
function presetField(lab) {
  let field = null;
  let shown = '';
  const node = element('div', { class: 'preset-field' });
  const fill = () => {
    const choices = presetChoices(lab);
    if (shown === JSON.stringify(choices)) return;
    shown = JSON.stringify(choices);
    const before = field?.value || '';
    const value = choices.some(([word]) => word === before) ? before : '';
    field = choiceOf({ label: 'New solids are of', choices, value });
    node.replaceChildren(field.node);
  };
  lab.on('scene', fill);
  fill();
  return { node, values: () => presetValues(field.value) };
}

/* Filled with the first scene, which lists the shapes. */
function shapeButtons(lab, preset) {
  const node = element('div', { class: 'buttons', role: 'group', 'aria-label': 'Add a solid' });
  const fill = () => {
    if (node.firstChild || !lab.scene) return;
    for (const { shape, meaning } of lab.scene.shapes) {
      const word = translated(shape);
      const label = word[0].toUpperCase() + word.slice(1);
      node.append(
        button(label, () => choice.add({ kind: 'solid', shape, set: preset.values() }), {
          small: true,
          title: meaning,
        }),
      );
    }
  };
  lab.on('scene', fill);
  fill();
  return node;
}

function addButtons(lab) {
  const small = (label, act, icon) => button(label, act, { small: true, icon });
  const preset = presetField(lab);
  return group(
    'Other shapes, lights and files',
    { id: 'edit.add', open: false },
    preset.node,
    shapeButtons(lab, preset),
    element(
      'div',
      { class: 'buttons', role: 'group', 'aria-label': 'Add other objects' },
      small('Light', () => choice.add({ kind: 'light' }), 'light'),
      small('Beam', () => choice.add({ kind: 'beam' }), 'beam'),
      small('Material', () => choice.add({ kind: 'material' })),
      small('Slime', () => choice.add({ kind: 'slime' }), 'drop'),
      small('Model …', () => files.addFile('model', 'Add a model'), 'cube'),
      small('Texture …', () => files.addFile('texture', 'Add a texture'), 'image'),
      small('Sky …', files.pickSky, 'cloud'),
      small('Data …', () => files.addFile('data', 'Add optical data')),
    ),
  );
}

function create(root, lab) {
  start(lab);
  root.append(
    fileButtons(lab),
    createPalette(lab, choice),
    addButtons(lab),
    createList(lab, choice).node,
    createDetails(lab, choice, files).node,
    createScenePads(lab),
  );
}

export const panel = { id: 'edit', title: 'Objects', css: 'edit/panel_edit.css', start, create };
