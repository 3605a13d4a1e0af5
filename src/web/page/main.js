/* Assembles the laboratory: one object lab (store.js), the image (view.js), the panels, header and status line.
 * Exports nothing; the browser's console can use lab. */

import { createLab } from './store.js';
import { createView } from './view.js';
import { createPanels } from './panels.js';
import { createHead } from './head.js';
import { createStatus } from './status.js';
import { createNotes } from './notes.js';
import { createBanner } from './banner.js';
import { createRescue } from './rescue.js';
import { createDisplay } from './display.js';
import { createKeys } from './keys.js';
import { orbitTool } from './tool_orbit.js';
import { lightTool } from './tool_light.js';
import { cameraBox } from './camera_box.js';
import { acceptDrops } from './shared_file.js';
import { namesScene, openLink } from './shared_link.js';

/* A panel that cannot be loaded does not affect the others. Written out for bundlers. */
const modules = [
  () => import('./panel_lessons.js'),
  () => import('./panel_params.js'),
  () => import('./panel_edit.js'),
  () => import('./panel_pixel.js'),
  () => import('./panel_bench.js'),
  () => import('./panel_compare.js'),
  () => import('./panel_slime.js'),
  () => import('./panel_studies.js'),
  () => import('./panel_machine.js'),
];

const at = (id) => document.getElementById(id);

async function start() {
  const lab = createLab();
  window.lab = lab;
  createStatus(at('status'), at('live'), lab);
  lab.notes = createNotes(lab);
  createBanner(at('banner'), [at('head'), at('rescue'), at('workspace')], lab);
  createRescue(at('rescue'), lab);
  lab.view = createView(at('view'), lab);
  orbitTool(lab);
  lightTool(lab);
  cameraBox(at('view'), lab);
  lab.view.use('orbit');
  createDisplay(lab);
  createHead(at('head'), lab);
  createKeys(lab);
  const loaded = await Promise.allSettled(modules.map((load) => load()));
  const panels = loaded.filter((each) => each.status === 'fulfilled').map((each) => each.value.panel);
  lab.panels = createPanels(at('side'), at('splitter'), at('workspace'), panels, lab);
  for (const each of loaded) if (each.status === 'rejected') lab.fail(each.reason);
  if (namesScene()) lab.panels.reveal();
  lab.start();
  acceptDrops(lab);
  await openLink(lab);
}

start();
