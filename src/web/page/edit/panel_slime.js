/* The panel Slime: plays the live slime, shows its motion, and edits its appearance and its body while it moves. The
 * tool Grab is in slime_grab.js.
 * exports: panel */

import { say } from '../shared/language.js';
import { button, choice, digits, element, empty, group, notice, replace, write } from '../shared/ui.js';
import { createGrab } from './slime_grab.js';
import { createCurve, createMotion } from './slime_motion.js';
import { createSliders } from './slime_sliders.js';

/* The solids that show a slime, each with its mesh. */
function slimes(lab) {
  const objects = lab.scene?.objects || [];
  const is = (name) => lab.param(`${name}.generate`)?.value === 'slime';
  return objects
    .filter((one) => one.kind === 'solid' && one.mesh && is(one.mesh))
    .map((one) => ({ solid: one.name, mesh: one.mesh }));
}

function stateText(slime) {
  if (!slime.on) return "Off: the image shows the slime at the scene's time_s";
  if (slime.trouble) return 'Stopped';
  if (!slime.playing) return 'Paused: full render';
  return slime.resting ? 'At rest: full render' : 'Moving: previews';
}

function controls(lab) {
  const order = (what) => lab.post('/api/slime', what).catch(lab.fail);
  const play = button('Play', () => order({ do: lab.slime?.playing ? 'pause' : 'play' }), {
    icon: 'play',
    kind: 'primary',
  });
  const restart = button('Restart', () => order({ do: 'restart' }), { icon: 'reset' });
  const off = button('Off', () => order({ do: 'off' }), {
    icon: 'stop',
    title: "Show the slime at the scene's time_s",
  });
  const grab = button(
    'Drag the slime in the image',
    () => {
      lab.view.use('grab');
      lab.view.stage.focus();
    },
    { icon: 'hand' },
  );
  const preview = choice({
    label: 'Preview',
    choices: [
      ['traced', 'Ray traced, low resolution'],
      ['zbuffer', 'Z-buffer'],
    ],
    radios: true,
    onchange: (word) => order({ preview: word }),
  });
  const state = element('p', { class: 'slime-state', role: 'status' });
  const node = element(
    'div',
    { class: 'slime-controls' },
    element('div', { class: 'buttons' }, play, restart, off, grab),
    preview.node,
    state,
  );
  return {
    node,
    show(slime) {
      const label = slime.playing ? 'Pause' : 'Play';
      const face = play.querySelector('.button-label');
      if (face.textContent !== label) {
        face.textContent = label;
        play.querySelector('.icon').replaceWith(button('', null, { icon: label.toLowerCase() }).querySelector('.icon'));
      }
      off.disabled = !slime.on;
      preview.set(slime.preview);
      const words = stateText(slime);
      write(state, { textContent: words });
    },
  };
}

/* Readings that change with each image, in fixed places. */
function readings() {
  const names = ['Time', 'Real time', 'Speed', 'Volume', 'Masses held'];
  const values = names.map(() => element('dd'));
  const node = element(
    'dl',
    { class: 'slime-readings' },
    names.map((name, index) => element('div', {}, element('dt', { text: name }), values[index])),
  );
  return {
    node,
    show(slime) {
      const volume = slime.volume_at_rest > 0 ? `${digits((100 * slime.volume) / slime.volume_at_rest, 4)} %` : '–';
      const texts = !slime.on
        ? names.map(() => '–')
        : [
            `${slime.time_s.toFixed(2)} s`,
            slime.playing && !slime.resting ? `${Math.round(100 * slime.realtime)} %` : '–',
            `${slime.speed === null ? '–' : digits(slime.speed, 3)} u/s`,
            volume,
            String(slime.held),
          ];
      texts.forEach((text, index) => {
        values[index].textContent = text;
      });
    },
  };
}

function tuning(lab) {
  const node = element('div', { class: 'slime-tuning' });
  const which = element('div');
  let shownKey = '';
  let chosen = null;
  let sliders = null;
  return {
    node,
    show() {
      const all = slimes(lab);
      const now = all.find((one) => one.solid === chosen) || all[0];
      const key = JSON.stringify([all, now]);
      if (key === shownKey) {
        sliders?.update();
        return;
      }
      shownKey = key;
      chosen = now?.solid;
      sliders = now ? createSliders(lab, now.solid, now.mesh) : null;
      replace(
        which,
        all.length > 1
          ? choice({
              label: 'Solid',
              choices: all.map((one) => one.solid),
              value: chosen,
              onchange: (word) => {
                chosen = word;
                this.show();
              },
            }).node
          : null,
      );
      replace(
        node,
        which,
        sliders
          ? [
              group('Appearance', { id: 'slime-looks', hint: 'editable while it moves' }, sliders.looks),
              group('Body', { id: 'slime-body', hint: 'a change restarts the slime' }, sliders.body),
            ]
          : notice('No solid shows the slime', {
              remedy: "set the solid's shape to mesh and its mesh to the slime's",
            }),
      );
    },
  };
}

let shown = () => undefined;
let visible = false;

export const panel = {
  id: 'slime',
  title: 'Slime',
  css: 'edit/panel_slime.css',
  start: createGrab,
  create(root, lab) {
    const parts = { controls: controls(lab), readings: readings(), tuning: tuning(lab) };
    const curve = createCurve();
    const trouble = element('div');
    let shownWords = '';
    const live = element(
      'div',
      { class: 'slime-live' },
      parts.controls.node,
      trouble,
      parts.readings.node,
      curve.node,
      parts.tuning.node,
      group(
        'Motion and theory',
        { id: 'slime-motion', open: false, hint: 'measured next to closed forms' },
        createMotion(lab).node,
      ),
    );
    const none = element(
      'div',
      { class: 'slime-none' },
      empty('This scene has no slime.'),
      element(
        'div',
        { class: 'buttons' },
        button('Add a slime', () => lab.change('/api/objects', { kind: 'slime' }).catch(lab.fail), {
          icon: 'plus',
          kind: 'primary',
        }),
      ),
    );
    root.append(live, none);

    const show = () => {
      if (!visible) return;
      const slime = lab.slime;
      live.hidden = !slime;
      none.hidden = Boolean(slime);
      if (!slime) return;
      parts.controls.show(slime);
      parts.readings.show(slime);
      const words = slime.trouble ? `${slime.trouble.error}|${slime.trouble.remedy}` : '';
      if (words !== shownWords)
        replace(
          trouble,
          slime.trouble
            ? notice(slime.trouble.error, {
                kind: 'error',
                remedy: say('{remedy}; or restart the slime', slime.trouble),
              })
            : null,
        );
      shownWords = words;
    };
    shown = () => {
      show();
      parts.tuning.show();
    };
    lab.on('slime', (slime) => {
      if (slime?.on) curve.add(slime);
      show();
    });
    lab.on('state', (state) => {
      if (!state.slime?.on) curve.clear();
      show();
    });
    lab.on('scene', () => parts.tuning.show());
    shown();
  },
  shown() {
    visible = true;
    shown();
  },
  hidden() {
    visible = false;
  },
};
