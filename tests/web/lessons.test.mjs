// Lessons: the gallery with its images, each lesson run through as a pupil does, its curve within the tolerance of
// theory, and the critical angle in two actions.

import { writeFile } from 'node:fs/promises';
import { join } from 'node:path';

const critical = (Math.asin(1 / 1.333) * 180) / Math.PI;

const panel = (screen) => screen.page.getByRole('tabpanel', { name: 'Lessons' });

/** The value that the panel shows, as a number. */
const reading = async (screen) =>
  parseFloat((await panel(screen).locator('.lesson-value').innerText()).replaceAll('\u2212', '-'));

export const cases = {
  'a laboratory without a scene starts with the gallery; the critical angle is two actions away': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab, { width: 1366, height: 768 });
    await panel(screen).locator('.lesson-card').nth(7).waitFor();
    await screen.until(() => [...document.querySelectorAll('.lesson-card img')].some((img) => img.naturalWidth > 100));
    await t.picture(screen, 'gallery-light');
    await t.axe(screen, 'gallery');
    await screen.page.getByRole('button', { name: /When water becomes a mirror/ }).click();
    await screen.button('Show the measurement').click();
    await panel(screen).locator('.lesson-value').waitFor();
    t.near(await reading(screen), critical, 0.1, 'the critical angle of water');
    const box = await panel(screen).locator('.lesson-value').boundingBox();
    t.check(box.y + box.height < 768, 'the reading is visible without scrolling');
    await screen.settled();
    await t.picture(screen, 'lesson-light');
    await t.axe(screen, 'lesson');
  },

  'each lesson is within its tolerance, and answers a prediction': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const { lessons } = await lab.get('/api/lessons');
    t.more(lessons.length, 7, 'lessons');
    await screen.showPanel('Lessons');
    for (const lesson of lessons) {
      await screen.page.getByRole('button', { name: new RegExp(`^${lesson.title.replace('?', '\\?')}`) }).click();
      const { choices, right } = lesson.prediction;
      if (choices) await panel(screen).getByRole('button', { name: right, exact: true }).click();
      else {
        const answer = panel(screen).getByRole('spinbutton', { name: lesson.prediction.ask });
        await answer.waitFor(); /* the lesson's scene is open, not the last one's */
        const truth = (await lab.get(`/api/lessons/${lesson.name}/measure`)).measured;
        await answer.fill(String(Math.round(truth)));
        await screen.button('Compare', true).click();
      }
      await panel(screen).getByText('That is right.').waitFor();
      await panel(screen).getByText(lesson.answer).waitFor();
      await panel(screen).locator('.lesson-chart .plot-marker').nth(8).waitFor({ state: 'attached' });
      const result = await lab.get(`/api/lessons/${lesson.name}/measure`);
      t.check(result.passes && result.error <= lesson.measure.tolerance, `${lesson.name}: ${result.error}`);
      t.near(
        await reading(screen),
        result.theory,
        Math.abs(result.theory) * 1e-5 + 1e-9,
        `${lesson.name}: the reading`,
      );
      await screen.button('All lessons').click();
      await panel(screen).locator('.lesson-card').first().waitFor();
    }
  },

  'a control changes scene, reading and command': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab, { dark: true });
    await screen.showPanel('Lessons');
    await screen.page.getByRole('button', { name: /When water becomes a mirror/ }).click();
    await screen.button('Show the measurement').click();
    const field = panel(screen).getByRole('spinbutton', { name: 'Refractive index of the liquid, number' });
    await field.fill('1.5');
    await field.press('Enter');
    await screen.until(() => window.lab.param('liquid.ior').value === 1.5);
    await panel(screen).getByText('41.8103°', { exact: true }).waitFor();
    t.match(
      await panel(screen).locator('.lesson-command code').last().textContent(),
      / --set liquid\.ior=1\.5$/,
      'command',
    );
    await screen.settled();
    await t.picture(screen, 'lesson-dark');
    await t.axe(screen, 'lesson, dark');
  },

  'keys move a control step by step over a slow link; nothing moves it back': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Lessons');
    await screen.page.getByRole('button', { name: /When water becomes a mirror/ }).click();
    const range = panel(screen).getByRole('slider', { name: 'Refractive index of the liquid' });
    await range.waitFor();
    await screen.settled();
    await screen.page.route('**/api/set', async (route) => {
      await new Promise((resolve) => setTimeout(resolve, 200));
      await route.continue();
    });
    const { generation } = await lab.get('/api/state');
    const start = Number(await range.inputValue());
    const seen = [];
    for (let i = 0; i < 30; i++) {
      await range.press('ArrowRight');
      seen.push(Number(await range.inputValue()) - start - (i + 1));
    }
    for (let i = 0; i < 20; i++) {
      await range.press('ArrowLeft');
      seen.push(Number(await range.inputValue()) - start - (29 - i));
    }
    await screen.page.waitForTimeout(1500);
    await screen.settled();
    t.equal(seen.filter(Boolean).length, 0, 'steps that were lost or undone');
    t.equal(Number(await range.inputValue()) - start, 10, 'steps at the end');
    const after = (await lab.get('/api/state')).generation;
    t.check(after - generation < 40, `${after - generation} generations for 50 keys`);
  },

  'a lesson whose scene is gone says so and starts again': async (t) => {
    const lab = await t.lab();
    const screen = await t.open(lab);
    await screen.page.getByRole('button', { name: /When water becomes a mirror/ }).click();
    const range = panel(screen).getByRole('slider', { name: 'Refractive index of the liquid' });
    await range.waitFor();
    await screen.settled();
    await screen.page.getByRole('button', { name: /^Undo/ }).first().click();
    await panel(screen).getByText('The scene of this lesson is not shown any more.').waitFor();
    t.check(await range.evaluate((node) => Boolean(node.closest('[inert]'))), 'the controls are inert');
    await screen.button('Start this lesson again').click();
    await panel(screen).getByText('The scene of this lesson is not shown any more.').waitFor({ state: 'hidden' });
    await screen.settled();
    t.check(await range.evaluate((node) => !node.closest('[inert]')), 'the controls work again');
  },

  'a broken lesson of the folder is shown with its place; scenes have thumbnails in the Open list': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    await writeFile(join(lab.folder, 'own.lesson'), 'lesson: own\ntitel: Own\n');
    const screen = await t.open(lab);
    await screen.showPanel('Lessons');
    await panel(screen).getByText("own.lesson: unknown key 'titel'").waitFor();
    t.equal((await lab.ask('GET', '/api/lessons/none/measure')).status, 404, 'an unknown lesson');
    await screen.showPanel('Objects');
    await screen.button('Open').first().click();
    await screen.until(() => document.querySelector('.file-list img')?.naturalWidth > 100);
    await t.picture(screen, 'open-light');
  },
};
