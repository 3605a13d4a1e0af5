/* Dialogs that open, save and choose files of the laboratory's folder.
 * exports: createFiles(lab, choice) -> {open(), fresh(), save(), saveAs(), pickSky(), addFile('model', 'texture' or
 * 'data', title), pick(title, kind, nothing, actions) -> promise of a name or null, forObject(object) -> node or null}
 *   nothing: the text if the folder has no such files */

import { say } from '../shared/language.js';
import { thumbnail } from '../shared/images.js';
import { saveReply } from '../shared/save_file.js';
import { ask, button, dialog, element, empty, notice, replace, unique } from '../shared/ui.js';

const NO_DATA = 'The folder contains no tables, glass catalogues or files of refractiveindex.info.';
const MANY = 8; /* longer lists get a search field */

export function createFiles(lab, choice) {
  /* In the browser the folder is in the page's memory: what is saved there is downloaded too. */
  const inFolder = lab.engine.kind === 'server';
  const ours = new Set(); /* files written by this page since they were opened; overwriting them loses nothing */

  return { open, fresh, save, saveAs, pickSky, pick, addFile, forObject };

  /* kind: a key of /api/files, or several; actions: buttons of the dialog in addition to Cancel */
  async function pick(title, kind, nothing, actions = []) {
    try {
      const files = await lab.get('/api/files');
      const names = [kind].flat().flatMap((each) => files[each]);
      const pictured = new Set([kind].flat().includes('scenes') ? files.scenes : []);
      return await chooser(title, names, files.folder, nothing, actions, pictured);
    } catch (error) {
      lab.fail(error);
      return null;
    }
  }

  function chooser(title, names, folder, nothing, actions, pictured) {
    const list = element('ul', { class: 'file-list' });
    const search = element('input', {
      type: 'search',
      class: 'input',
      id: unique('find'),
      spellcheck: 'false',
      placeholder: 'Find',
    });
    const content = element(
      'div',
      { class: 'file-choice' },
      element('p', { class: 'hint', text: inFolder ? say('Folder {folder}', { folder }) : 'Files of this page' }),
      names.length > MANY ? element('label', { class: 'visually-hidden', for: search.id, text: 'Find a file' }) : null,
      names.length > MANY ? search : null,
      names.length ? list : empty(nothing),
    );
    const made = dialog({ title, content, actions: [...actions, ['Cancel', null]] });
    made.node.classList.add('file-dialog');
    const fill = () => {
      const words = search.value.toLowerCase().split(/\s+/).filter(Boolean);
      const fitting = names.filter((name) => words.every((word) => name.toLowerCase().includes(word)));
      replace(
        list,
        fitting.length
          ? fitting.map((name) =>
              element(
                'li',
                {},
                element(
                  'button',
                  {
                    type: 'button',
                    class: 'object-item',
                    'aria-current': name === lab.state?.file ? 'true' : null,
                    onclick: () => made.close(name),
                  },
                  pictured.has(name) ? thumbnail(lab, `/api/thumbnail.jpg?file=${encodeURIComponent(name)}`) : null,
                  ...named(name),
                ),
              ),
            )
          : element('li', { class: 'hint', text: 'No file name matches.' }),
      );
    };
    search.addEventListener('input', fill);
    fill();
    (names.length > MANY ? search : list.querySelector('button'))?.focus();
    return made.closed;
  }

  function named(name) {
    const at = name.lastIndexOf('/') + 1;
    return [
      element('span', { class: 'object-hint', translate: 'no', text: name.slice(0, at) }),
      element('span', { class: 'object-name', translate: 'no', text: name.slice(at) }),
    ];
  }

  /* Whether the current scene may be replaced: it is saved, or the user agrees. Undo restores it while the
   * laboratory runs. */
  async function mayLeave() {
    if (!lab.state?.unsaved) return true;
    const about = { name: lab.state.file || say('This scene') };
    const answer = await dialog({
      title: 'Unsaved changes',
      content: element('p', {
        text: inFolder
          ? say('{name} has unsaved changes. Undo restores them only while the laboratory runs.', about)
          : say('{name} has unsaved changes. Undo restores them only while this page is open.', about),
      }),
      actions: [
        ['Cancel', null],
        ['Continue without saving', 'go', 'danger'],
        ['Save first', 'save', 'primary'],
      ],
    }).closed;
    return answer === 'save' ? save() : answer === 'go';
  }

  async function opened(body) {
    try {
      const { note } = await lab.change('/api/open', body);
      ours.delete(body.file);
      choice.choose('');
      lab.say(body.file ? say('{file} opened.', body) : 'New scene opened.', note);
    } catch (error) {
      lab.fail(error);
    }
  }

  async function open() {
    if (!(await mayLeave())) return;
    const file = await pick('Open a scene or a lens file', ['scenes', 'lenses'], 'The folder contains no scenes.');
    if (file) await opened({ file });
  }

  async function fresh() {
    if (await mayLeave()) await opened({ new: true });
  }

  /* Saves into the scene's file. Asks before, unless this page wrote the file: a file written by hand may contain more
   * than the scene. The server refuses to replace any other file, and write() then asks. */
  async function overwrite(file, failed) {
    if (!inFolder) return write(file, true, failed);
    const answer = ours.has(file)
      ? 'replace'
      : await dialog({
          title: 'Replace the file',
          content: element('p', {
            text: say('Replace {file}? The file is rewritten and its comments are lost.', { file }),
          }),
          actions: [
            ['Cancel', null],
            ['Save as …', 'as'],
            ['Replace', 'replace', 'danger'],
          ],
        }).closed;
    if (answer === 'as') return saveAs(file);
    return answer === 'replace' && write(file, false, failed);
  }

  async function write(file, replaces, failed = lab.fail) {
    try {
      await lab.change('/api/save', replaces ? { file, replace: true } : { file });
      ours.add(file);
      if (inFolder) lab.say(say('{name} saved.', { name: file }));
      else await saveReply(lab, '/api/scene.yaml', file.split('/').pop());
      return true;
    } catch (error) {
      if (error.status !== 409) return Boolean(await failed(error));
      return (
        (await ask(
          'Replace the file',
          say('The file {file} already exists. Replace it?', { file }),
          'Replace',
          'danger',
        )) && write(file, true, failed)
      );
    }
  }

  function save() {
    if (lab.state?.file) return overwrite(lab.state.file);
    return inFolder ? saveAs() : write(`${lab.name()}.yaml`, true);
  }

  /* After an error the dialog keeps the name for correction. */
  async function saveAs(again, problem) {
    const proposed = typeof again === 'string' ? again : lab.state?.file || `${lab.name?.() || 'scene'}.yaml`;
    const input = element('input', {
      type: 'text',
      class: 'input',
      id: unique('file'),
      spellcheck: 'false',
      autocomplete: 'off',
      value: proposed,
    });
    const field = element(
      'div',
      { class: 'field wide' },
      element('label', {
        for: input.id,
        text: inFolder ? "File name, relative to the laboratory's folder" : 'File name',
      }),
      element('span', { class: 'field-control' }, input),
    );
    const made = dialog({
      title: 'Save the scene as',
      content: problem ? [field, notice(problem.message, { kind: 'error', remedy: problem.remedy })] : field,
      actions: [
        ['Cancel', null],
        ['Save', () => input.value.trim(), 'primary'],
      ],
    });
    input.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter') return;
      event.preventDefault(); /* Enter would press the button that gets the focus back */
      made.close(input.value.trim());
    });
    input.focus();
    input.setSelectionRange(input.value.lastIndexOf('/') + 1, input.value.replace(/\.ya?ml$/, '').length);
    const name = await made.closed;
    if (!name) return false;
    const file = `${name.replace(/(\.ya?ml)+$/i, '')}${name.match(/\.ya?ml$/i)?.[0] || '.yaml'}`;
    const mend = (error) => saveAs(file, error);
    return file === lab.state?.file ? overwrite(file, mend) : write(file, !inFolder, mend);
  }

  /* The file's path relative to the scene's own folder. */
  async function asPath(name) {
    return `${(await lab.get('/api/files')).prefix}${name}`;
  }

  /* none() -> the values to set if an action was chosen instead of a file. */
  async function setFile(path, title, kind, nothing, actions, none) {
    const name = await pick(title, kind, nothing, actions);
    if (name === null) return;
    try {
      await lab.set(name ? { [path]: await asPath(name) } : none());
      lab.say(say('{path} is {value}.', { path, value: name || say('none') }));
    } catch (error) {
      lab.fail(error);
    }
  }

  function pickSky() {
    const kind = lab.param('background.kind');
    const away = kind?.value === 'image' ? [['No image', '']] : [];
    return setFile('background.image', 'Sky image', 'images', 'The folder contains no images.', away, () => {
      const plain =
        kind.initial && kind.initial !== 'image' ? kind.initial : kind.choices.find((word) => word !== 'image');
      return { 'background.kind': plain };
    });
  }

  async function addFile(kind, title) {
    const [use, nothing] = {
      model: ['models', 'The folder contains no models.'],
      texture: ['images', 'The folder contains no images.'],
      data: ['data', NO_DATA],
    }[kind];
    const file = await pick(title, use, nothing);
    if (!file) return;
    if (!/\.agf$/i.test(file)) return choice.add({ kind, file });
    const glass = await askGlass(file);
    if (glass) await choice.add({ kind, file, set: { glass } });
  }

  /* A catalogue has many glasses, and no one of them is the usual one. */
  async function askGlass(file) {
    const input = element('input', { type: 'text', class: 'input', id: unique('glass'), spellcheck: 'false' });
    const field = element(
      'div',
      { class: 'field wide' },
      element('label', { for: input.id, text: say('Glass of {file}', { file: file.split('/').pop() }) }),
      element('span', { class: 'field-control' }, input),
    );
    const made = dialog({
      title: 'Choose a glass',
      content: field,
      actions: [
        ['Cancel', null],
        ['Add', () => input.value.trim(), 'primary'],
      ],
    });
    input.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter') return;
      event.preventDefault(); /* Enter would press the button that gets the focus back */
      made.close(input.value.trim());
    });
    input.focus();
    return made.closed;
  }

  /* Buttons for the files of an object. */
  function forObject(object) {
    const of = (name) => lab.param(`${object.name}.${name}`);
    const parts = [];
    if (object.kind === 'texture')
      parts.push([
        'Choose an image …',
        () => setFile(`${object.name}.file`, 'Image', 'images', 'The folder contains no images.'),
      ]);
    if (object.kind === 'data')
      parts.push(['Choose a data file …', () => setFile(`${object.name}.file`, 'Optical data', 'data', NO_DATA)]);
    if (object.kind === 'mesh' && of('file'))
      parts.push([
        'Choose a model …',
        () => setFile(`${object.name}.file`, 'Model', 'models', 'The folder contains no models.'),
      ]);
    if (object.kind === 'mesh' && of('script')) {
      parts.push([
        'Choose a hand script …',
        () => setFile(`${object.name}.script`, 'Hand script', 'scripts', 'The folder contains no hand scripts.'),
      ]);
    }
    return parts.length
      ? element(
          'div',
          { class: 'buttons' },
          parts.map(([label, act]) => button(label, act, { icon: 'folder', small: true })),
        )
      : null;
  }
}
