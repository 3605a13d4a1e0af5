/* Assembles the laboratory: one object lab (store.js), the image (view.js), the panels, header and status line.
 * Exports nothing; the browser's console can use lab. */

import { createLab } from './shared/store.js';
import { createView } from './view/view.js';
import { createPanels } from './panels.js';
import { createHead } from './head.js';
import { createBanner, createStatus } from './status.js';
import { createNotes } from './shared/notes.js';
import { createRescue } from './rescue.js';
import { createEmbed } from './embed.js';
import { createEscape } from './shared/escape.js';
import { createPrint } from './shared/print.js';
import { createDisplay } from './shared/display.js';
import { createKeys } from './keys.js';
import { createTips } from './shared/tips.js';
import { orbitTool } from './view/camera_moves.js';
import { lightTool } from './view/point_handles.js';
import { cameraBox } from './view/camera_box.js';
import { glassOutline } from './view/glass_outline.js';
import { acceptDrops, namesScene, openLink } from './shared/share.js';

/* A panel that cannot be loaded does not affect the others. Bundlers follow only imports that are written out. */
const modules = [
  () => import('./lessons/panel_lessons.js'),
  () => import('./edit/panel_params.js'),
  () => import('./edit/panel_edit.js'),
  () => import('./bench/panel_pixel.js'),
  () => import('./bench/panel_bench.js'),
  () => import('./bench/panel_lens.js'),
  () => import('./view/panel_compare.js'),
  () => import('./edit/panel_slime.js'),
  () => import('./studies/panel_studies.js'),
  () => import('./studies/panel_machine.js'),
];

const at = (id) => document.getElementById(id);

async function start() {
  const lab = createLab();
  window.lab = lab;
  createStatus(at('status'), at('live'), lab);
  createEscape(lab);
  lab.notes = createNotes(lab);
  createBanner(at('banner'), [at('head'), at('rescue'), at('workspace')], lab);
  createRescue(at('rescue'), lab);
  lab.view = createView(at('view'), lab);
  orbitTool(lab);
  lightTool(lab);
  cameraBox(at('view'), lab);
  glassOutline(lab);
  lab.view.use('orbit');
  createDisplay(lab);
  createHead(at('head'), lab);
  createKeys(lab);
  createTips();
  createPrint(lab);
  const loaded = await Promise.allSettled(modules.map((load) => load()));
  const panels = loaded.filter((each) => each.status === 'fulfilled').map((each) => each.value.panel);
  lab.panels = createPanels(at('side'), at('splitter'), at('workspace'), panels, lab);
  createEmbed(at('status'), lab);
  for (const each of loaded) if (each.status === 'rejected') lab.fail(each.reason);
  if (namesScene()) lab.panels.reveal();
  lab.start();
  acceptDrops(lab);
  await openLink(lab);
}

start();
