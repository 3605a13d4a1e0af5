/* The panel Lessons: a gallery of guided experiments, the start page of a laboratory without a scene; and the lesson
 * that was chosen, next to the image. exports: panel */

import { thumbnail } from '../shared/images.js';
import { name, named, returned, session } from '../shared/address.js';
import { namesScene } from '../shared/share.js';
import { element, empty, notice, replace } from '../shared/ui.js';
import { freeCard } from './free_card.js';
import { createLesson } from './lesson.js';

let place = null;
let lesson = null; /* the view of the chosen lesson; null in the gallery */
let covers = true; /* the image: in the gallery */
let loaded = false;
let wanted = ''; /* the lesson that the page's address names */

function cover(on) {
  covers = on;
  document.getElementById('workspace').classList.toggle('wide', on);
}

/* The page has small images of the program's lessons (make page-images), in a page of one file as an element; for a
 * folder's own lessons the laboratory renders one. */
function cardImage(lab, one) {
  const rendered = () => thumbnail(lab, `/api/lessons/${encodeURIComponent(one.name)}/thumbnail.jpg`);
  if (one.own && lab.engine.kind === 'server') return rendered();
  const kept = document.getElementById('cuvette-images');
  const bytes = kept && JSON.parse(kept.textContent)[one.name];
  const node = element('img', { class: 'thumbnail', alt: '', width: 240, height: 180, loading: 'lazy' });
  node.addEventListener('error', () => node.replaceWith(rendered()), { once: true });
  node.src = bytes ? `data:image/jpeg;base64,${bytes}` : `lessons/${encodeURIComponent(one.name)}.jpg`;
  return node;
}

function card(lab, one) {
  if (one.error) return notice(`${one.file}: ${one.error.error}`, { kind: 'warning', remedy: one.error.remedy });
  return element(
    'button',
    { type: 'button', class: 'lesson-card', lang: one.language, onclick: () => choose(lab, one) },
    cardImage(lab, one),
    element('span', { class: 'lesson-card-title', text: one.title }),
    element('span', { class: 'lesson-card-question', text: one.question }),
  );
}

async function gallery(lab) {
  lesson?.end();
  lesson = null;
  if (!wanted && named().lesson) name('');
  cover(true);
  replace(place, empty('Reading the lessons …'));
  try {
    const { lessons } = await lab.get('/api/lessons');
    replace(
      place,
      element('h3', { class: 'lesson-head', text: 'Experiments with light' }),
      element('p', {
        class: 'lesson-lead',
        text: 'Choose a question. Predict, measure with traced rays, compare with the textbook.',
      }),
      lessons.length
        ? element(
            'div',
            { class: 'lesson-cards' },
            freeCard(lab),
            lessons.map((one) => card(lab, one)),
          )
        : empty('There are no lessons: the laboratory is not installed completely.'),
    );
    const asked = lessons.find((one) => one.name === wanted);
    wanted = '';
    if (asked && returned() && (await lab.rescue.hasScene())) show(lab, asked);
    else if (asked) await choose(lab, asked);
  } catch (error) {
    replace(place, notice(error.message, { kind: 'error', remedy: error.remedy }));
  }
}

async function choose(lab, one) {
  try {
    if (lab.state && !lab.state.saved) lab.say('Undo restores the previous scene.');
    await lab.change(`/api/lessons/${encodeURIComponent(one.name)}/open`, {});
    lab.choice?.choose('');
    session.drop('lesson');
    show(lab, one);
  } catch (error) {
    lab.fail(error);
  }
}

/* The view of a lesson whose scene is shown. */
function show(lab, one) {
  cover(false);
  lesson?.end();
  lesson = createLesson(place, lab, one, { back: () => gallery(lab), again: () => choose(lab, one) });
}

export const panel = {
  id: 'lessons',
  title: 'Lessons',
  css: 'lessons/panel_lessons.css',
  get wide() {
    return covers;
  },
  /* A laboratory that opens neither a file nor a link starts with the gallery. */
  start(lab) {
    wanted = named().lesson;
    if (!wanted && (namesScene() || returned())) return;
    const end = lab.on('state', (state) => {
      end();
      if (wanted || (!state.file && !state.undo)) lab.panels.select('lessons');
    });
  },
  create(root, lab) {
    place = root;
    this.lab = lab;
  },
  shown() {
    if (!loaded) gallery(this.lab);
    else lesson?.shown();
    loaded = true;
  },
};
