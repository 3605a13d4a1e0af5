// Undo, redo, saving, opening and copying: the film of the page equals that of `cuvette render` for the file.
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { readPng } from './png.mjs';
import { difference } from './screen.mjs';

const filmOf = async (lab, ...words) => JSON.parse(await lab.run('render', ...words, '--json')).film_hash;
const shownFilm = (screen) => screen.page.evaluate(() => window.lab.image.film_hash);

/** Calls a function that changes the scene and waits for the final image. */
async function change(screen, act) {
  const { generation } = await screen.lab.get('/api/state');
  await act();
  await screen.until((g) => window.lab.newestGeneration > g, generation);
  await screen.settled(generation + 1);
}

export const cases = {
  'undo and redo, by buttons and keys': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const first = await shownFilm(screen);
    t.equal(first, await filmOf(lab, 'scenes/rod.yaml'), 'the film of the opened scene');
    t.equal(await screen.button('Undo').isEnabled(), false, 'undo is enabled in an unchanged scene');
    await screen.setNumber('liquid.ior', 1.6);
    await screen.setNumber('rod.reflectivity', 0.5);
    const both = await shownFilm(screen);
    t.equal(
      both,
      await filmOf(lab, 'scenes/rod.yaml', '--set', 'liquid.ior=1.6', '--set', 'rod.reflectivity=0.5'),
      'the film with both values',
    );
    await change(screen, () => screen.button('Undo').click());
    t.equal(await lab.value('rod.reflectivity'), 0, 'the newer change is undone first');
    t.equal(await lab.value('liquid.ior'), 1.6, 'the older change is not undone');
    // The shortcuts work on the page, not in a text field, which has its own undo.
    await screen.stage.focus();
    await change(screen, () => screen.page.keyboard.press('Control+z'));
    t.equal(await shownFilm(screen), first, 'after undoing both changes: the first film');
    t.equal(await screen.button('Undo').isEnabled(), false, 'undo is disabled again');
    await change(screen, () => screen.button('Redo').click());
    await change(screen, () => screen.page.keyboard.press('Control+Shift+Z'));
    t.equal(await shownFilm(screen), both, 'after redoing both changes: the film');
    await change(screen, () => screen.page.keyboard.press('Control+z'));
    await change(screen, () => screen.page.keyboard.press('Control+y'));
    t.equal(await shownFilm(screen), both, 'after Control+Y: the film');
    t.equal(await screen.button('Redo').isEnabled(), false, 'redo is enabled after the last redo');
  },

  'a drag of a slider is one step of undo': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const slider = await screen.paramSlider('liquid.ior');
    const box = await slider.boundingBox();
    const at = await slider.evaluate((input) => (input.value - input.min) / (input.max - input.min));
    await change(screen, async () => {
      await screen.page.mouse.move(box.x + 8 + (box.width - 16) * at, box.y + box.height / 2);
      await screen.page.mouse.down();
      await screen.page.mouse.move(box.x + box.width - 20, box.y + box.height / 2, { steps: 30 });
      await screen.page.mouse.up();
    });
    const dragged = await lab.value('liquid.ior');
    t.more(dragged, 1.34, 'the index after the drag');
    await change(screen, () => screen.button('Undo').click());
    t.equal(await lab.value('liquid.ior'), 1.33, 'the index after one undo');
    await change(screen, () => screen.button('Redo').click());
    t.equal(await lab.value('liquid.ior'), dragged, 'the index after one redo');
  },

  reset: async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const first = await shownFilm(screen);
    await screen.setNumber('liquid.ior', 1.7);
    await screen.setNumber('render.depth', 2);
    await screen.button('Reset liquid.ior').first().click();
    await screen.settled();
    await screen.until(() => window.lab.param('liquid.ior').value === 1.33);
    t.equal(await lab.value('render.depth'), 2, 'a reset of one value does not change others');
    await screen.button('Reset all').click();
    await change(screen, () => screen.page.getByRole('dialog').getByRole('button', { name: 'Reset all' }).click());
    t.equal(await shownFilm(screen), first, 'the film after the reset');
    await change(screen, () => screen.button('Undo').click());
    t.equal(await lab.value('render.depth'), 2, 'a reset can be undone');
  },

  'a scene saved under another name can be opened': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.setNumber('liquid.ior', 1.5);
    await screen.setNumber('render.depth', 6);
    const film = await shownFilm(screen);
    await screen.showPanel('Objects');
    await screen.button('Save as').click();
    const dialog = screen.page.getByRole('dialog', { name: 'Save the scene as' });
    await t.axe(screen, 'the dialog Save the scene as');
    await dialog.getByRole('textbox').fill('scenes/denser.yaml');
    await dialog.getByRole('button', { name: 'Save', exact: true }).click();
    await screen.until(() => window.lab.state.file === 'scenes/denser.yaml' && window.lab.state.saved);
    t.match(await readFile(join(lab.folder, 'scenes/denser.yaml'), 'utf8'), /ior: 1\.5/, 'the file has the new index');
    t.equal(await filmOf(lab, 'scenes/denser.yaml'), film, 'the film of cuvette render for the saved file');
    await screen.load();
    t.equal(await shownFilm(screen), film, 'the film after loading the page again');
    for (const [file, expected] of [
      ['rod', await filmOf(lab, 'scenes/rod.yaml')],
      ['denser', film],
    ]) {
      await screen.showPanel('Objects');
      await screen.button('Open').click();
      const choice = screen.page.getByRole('dialog', { name: 'Open a scene' });
      await choice.getByRole('searchbox').fill(`scenes/${file}.yaml`);
      await change(screen, () => choice.getByRole('listitem').getByRole('button').click());
      t.equal(await shownFilm(screen), expected, `the film of ${file}.yaml opened in the page`);
    }
  },

  'an existing file is not overwritten without confirmation': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    screen.expect(/409/);
    const before = await readFile(join(lab.folder, 'scenes/prism.yaml'), 'utf8');
    await screen.showPanel('Objects');
    await screen.button('Save as').click();
    const dialog = screen.page.getByRole('dialog', { name: 'Save the scene as' });
    await dialog.getByRole('textbox').fill('scenes/prism.yaml');
    await dialog.getByRole('textbox').press('Enter');
    const question = screen.page.getByRole('dialog', { name: 'Replace the file' });
    await question.getByRole('button', { name: 'Cancel' }).click();
    await screen.quiet();
    t.equal(await readFile(join(lab.folder, 'scenes/prism.yaml'), 'utf8'), before, 'the other file');
    t.equal((await lab.get('/api/state')).file, 'scenes/rod.yaml', 'the scene keeps its file');
  },

  'saving outside of the folder is refused': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    screen.expect(/400/);
    await screen.showPanel('Objects');
    await screen.button('Save as').click();
    const dialog = screen.page.getByRole('dialog', { name: 'Save the scene as' });
    await dialog.getByRole('textbox').fill('../outside.yaml');
    await dialog.getByRole('textbox').press('Enter');
    await dialog.getByText('outside.yaml').waitFor();
    t.equal((await lab.get('/api/state')).file, 'scenes/rod.yaml', 'the file of the scene after the refusal');
    t.equal(await dialog.getByRole('textbox').inputValue(), '../outside.yaml', 'the refused name stays in the field');
    await dialog.getByRole('textbox').fill('inside.yaml.yaml');
    await dialog.getByRole('textbox').press('Enter');
    await screen.until(() => window.lab.state.file === 'inside.yaml' && window.lab.state.saved);
    t.match(await readFile(join(lab.folder, 'inside.yaml'), 'utf8'), /liquid/, 'the file under the corrected name');
  },

  'Control+S saves, including a value that is being typed': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.setNumber('render.depth', 3);
    const field = screen.page.getByRole('spinbutton', { name: 'liquid ior, number', exact: true }).first();
    await field.fill('1.45');
    await field.press('Control+s');
    await screen.page
      .getByRole('dialog', { name: 'Replace the file' })
      .getByRole('button', { name: 'Replace', exact: true })
      .click();
    await screen.until(() => window.lab.state.saved);
    const text = await readFile(join(lab.folder, 'scenes/rod.yaml'), 'utf8');
    t.match(text, /depth: 3/, 'the file has the new depth');
    t.match(text, /ior: 1\.45/, 'the file has the value that was being typed');
  },

  'a file written by hand is replaced after one confirmation': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const text = () => readFile(join(lab.folder, 'scenes/rod.yaml'), 'utf8');
    const byHand = await text();
    t.match(byHand, /^#/m, 'the file has comments');
    const question = screen.page.getByRole('dialog', { name: 'Replace the file' });
    const naming = screen.page.getByRole('dialog', { name: 'Save the scene as' });
    const answer = (dialog, name) => dialog.getByRole('button', { name, exact: true }).click();
    const save = () => screen.button('Save', true).click();
    await screen.setNumber('render.depth', 3);
    await screen.showPanel('Objects');
    await save();
    await question.getByText('Replace scenes/rod.yaml? The file is rewritten and its comments are lost.').waitFor();
    await t.axe(screen, 'the dialog Replace the file');
    await answer(question, 'Cancel');
    await save();
    await answer(question, 'Save as …');
    await answer(naming, 'Save'); // the same name again
    await answer(question, 'Cancel');
    await screen.quiet();
    t.equal(await text(), byHand, 'the file before the confirmation');
    await save();
    await answer(question, 'Replace');
    await screen.until(() => window.lab.state.saved);
    t.match(await text(), /depth: 3/, 'the file has the new depth');
    await screen.setNumber('render.depth', 5);
    await screen.until(() => !window.lab.state.saved);
    await screen.stage.focus();
    await screen.page.keyboard.press('Control+s');
    await screen.until(() => window.lab.state.saved);
    t.match(await text(), /depth: 5/, 'the second save needs no confirmation');
    await screen.showPanel('Objects');
    await screen.button('Open').click();
    const choice = screen.page.getByRole('dialog', { name: 'Open a scene' });
    await choice.getByRole('searchbox').fill('scenes/rod.yaml');
    await change(screen, () => choice.getByRole('listitem').getByRole('button').click());
    await save();
    await answer(question, 'Cancel');
  },

  media: async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Parameters');
    const medium = screen.page.getByRole('combobox', { name: 'liquid medium', exact: true }).first();
    const unused = screen.page.locator('.param[data-path="liquid.ior"]').first().getByText('unused');
    t.equal(await unused.isVisible(), false, 'the index is marked as unused');
    await change(screen, () => medium.selectOption('diamond'));
    await unused.waitFor();
    t.equal(await lab.value('liquid.medium'), 'diamond', 'the medium');
    for (const law of ['cauchy', 'sellmeier', 'table']) {
      await change(screen, () => medium.selectOption(law));
      t.equal(await lab.value('liquid.medium'), law, `${law}: the medium`);
      t.more((await lab.value('liquid.coefficients')).length, 1, `${law}: number of coefficients`);
      t.equal(
        await screen.page.getByRole('textbox', { name: 'liquid coefficients', exact: true }).first().isVisible(),
        true,
        `${law}: the field of the coefficients is visible`,
      );
    }
    await change(screen, () => medium.selectOption('ior'));
    await unused.waitFor({ state: 'hidden' });
    await change(screen, () => medium.selectOption('water'));
    await unused.waitFor();
    const slider = await screen.paramSlider('liquid.ior');
    await change(screen, () => slider.press('ArrowRight'));
    await unused.waitFor({ state: 'hidden' });
    t.equal(await medium.inputValue(), 'ior', 'setting the index replaces the medium');
  },

  'the page reopens on every panel': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const names = await screen.panelNames();
    for (const name of ['Parameters', 'Objects', 'Machine']) {
      await screen.showPanel(name);
      await screen.load();
      for (const other of names) await screen.showPanel(other);
      t.equal(await screen.page.getByText('This panel failed').count(), 0, `opened on ${name}: panels that failed`);
    }
  },

  'main parameters are found first': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.showPanel('Parameters');
    await screen.page.getByRole('searchbox', { name: 'Find a parameter' }).fill('refractive index');
    const found = screen.page.locator('.param-list:not([hidden]) > .param');
    await screen.until(() => document.querySelectorAll('.param-list:not([hidden]) > .param').length > 2);
    const paths = await found.evaluateAll((rows) => rows.map((row) => row.dataset.path));
    t.equal(paths.slice(0, 2), ['vessel.ior', 'liquid.ior'], 'the first results');
  },

  'a rejected camera value is reset in its field': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    screen.expect(/400/);
    await screen.button('Camera', true).click();
    for (const [label, wrong, right] of [
      ['Field of view', '500', '45'],
      ['Position x', '1e9', '0'],
    ]) {
      const field = screen.page.getByRole('spinbutton', { name: label, exact: true });
      await field.fill(wrong);
      await field.press('Enter');
      await screen.quiet();
      await field.blur();
      t.equal(await field.inputValue(), right, `${label} after the rejected value ${wrong}`);
    }
  },

  'a sky image is set and removed': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    const before = await shownFilm(screen);
    await screen.showPanel('Objects');
    await screen.button('Sky').click();
    const dialog = screen.page.getByRole('dialog', { name: 'Sky image' });
    t.equal(
      await dialog.getByRole('button', { name: 'No image' }).count(),
      0,
      'buttons that remove a missing sky image',
    );
    await change(screen, () => dialog.getByRole('listitem').getByRole('button').first().click());
    t.check((await shownFilm(screen)) !== before, 'a sky image changes the film');
    await screen.button('Sky').click();
    await change(screen, () => dialog.getByRole('button', { name: 'No image' }).click());
    t.equal(await shownFilm(screen), before, 'the film after its removal');
  },

  'a rejected value does not change the slider': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    screen.expect(/400/);
    const slider = await screen.paramSlider('render.width');
    const before = await slider.inputValue();
    const field = screen.page.getByRole('spinbutton', { name: 'render width, number', exact: true }).first();
    await field.fill('60000');
    await field.press('Enter');
    await screen.page.getByText('pixels exceed the laboratory').first().waitFor();
    t.equal(await slider.inputValue(), before, 'the value of the slider');
    t.equal(await field.inputValue(), '800', 'the value of the number field');
  },

  'the image, the render command and the scene file are exported': async (t) => {
    const lab = await t.lab('scenes/rod.yaml');
    const screen = await t.open(lab);
    await screen.context.grantPermissions(['clipboard-read', 'clipboard-write'], { origin: lab.origin });
    await screen.setNumber('liquid.ior', 1.45);
    const film = await shownFilm(screen);
    await screen.button('Save image').click();
    const box = screen.page.getByRole('dialog', { name: 'Save image' });
    const [download] = await Promise.all([
      screen.page.waitForEvent('download'),
      box.getByRole('button', { name: 'Save' }).click(),
    ]);
    t.equal(download.suggestedFilename(), 'rod.png', 'the name of the image');
    const saved = readPng(await readFile(await download.path()));
    t.equal(difference(saved, await screen.served()), 0, "share of pixels that differ from the server's image");
    await screen.button('Copy render command').click();
    await screen.page.locator('#status').getByText('The command is on the clipboard').waitFor();
    const command = await screen.page.evaluate(() => navigator.clipboard.readText());
    const words = command.split(' ');
    t.equal(words.slice(0, 2), ['cuvette', 'render'], 'the command');
    const account = JSON.parse(await lab.run(...words.slice(1), '--json'));
    t.equal(account.film_hash, film, `the film of ${command}`);
    await screen.button('Copy scene file').click();
    await screen.page.locator('#status').getByText('The scene file is on the clipboard').waitFor();
    t.match(
      await screen.page.evaluate(() => navigator.clipboard.readText()),
      /ior: 1\.45/,
      'the scene file on the clipboard',
    );
  },
};
