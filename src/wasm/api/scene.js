/* Scenes: the content of a scene file, and its parameters by name. See "scenes", "parameters" and "objects" in
 * cuvette.h.
 *
 * exports: Scene */

import { badInput } from './errors.js';
import { Handle } from './handle.js';
import { Motion } from './motion.js';
import { Query } from './query.js';

let folders = 0;

function makeFolder(FS, path) {
  const parts = path.split('/');
  for (let i = 2; i <= parts.length; i++) {
    const part = parts.slice(0, i).join('/');
    if (!FS.analyzePath(part).exists) FS.mkdir(part);
  }
}

/* The files of a scene and its clones, in a folder that is removed when the scene and all clones are released. */
class Files {
  /* name: path of the scene file in the folder, which may have subfolders; files: {path in the folder: bytes}. */
  constructor(FS, name, files) {
    this.FS = FS;
    this.users = 1;
    this.path = '/';
    this.names = Object.keys(files);
    if (!this.names.length) return;
    this.path = `/scenes/${++folders}`;
    try {
      this.#write(name, files);
    } catch (error) {
      this.release();
      throw error;
    }
  }

  #write(name, files) {
    makeFolder(this.FS, `${this.path}/${name}`.replace(/\/[^/]*$/, ''));
    for (const name of this.names) {
      const path = `${this.path}/${name}`;
      if (name.split('/').some((part) => !part || part === '.' || part === '..'))
        throw badInput(
          `'${name}' is not a name of a file below the scene's folder`,
          "leave out '..' and '/' at its start",
        );
      makeFolder(this.FS, path.slice(0, path.lastIndexOf('/')));
      this.FS.writeFile(path, files[name]);
    }
  }

  release() {
    if (--this.users || this.path === '/') return;
    this.FS.chdir('/');
    this.#remove(this.path);
  }

  #remove(path) {
    for (const name of this.FS.readdir(path).filter((one) => one !== '.' && one !== '..')) {
      const at = `${path}/${name}`;
      if (this.FS.isDir(this.FS.stat(at).mode)) this.#remove(at);
      else this.FS.unlink(at);
    }
    this.FS.rmdir(path);
  }
}

export class Scene extends Handle {
  static kind = 'Scene';
  #memory;
  #files;

  constructor(memory, address, files) {
    super(address, () => {
      memory.call('cuvette_scene_destroy', address);
      files.release();
    });
    this.#memory = memory;
    this.#files = files;
  }

  /* Reads a scene's text. name: of the scene file, for errors and as the place that paths in the scene are relative to.
   * files: {name: bytes}, the images and meshes that the scene uses. */
  static read(memory, text, { name = 'scene.yaml', files = {} } = {}) {
    const bytes = typeof text === 'string' ? new TextEncoder().encode(text) : text;
    const folder = new Files(memory.module.FS, name, files);
    memory.module.FS.chdir(folder.path);
    try {
      return new Scene(memory, memory.handle('cuvette_scene_read_text', name, bytes, bytes.length), folder);
    } catch (error) {
      folder.release();
      throw error;
    }
  }

  static create(memory) {
    return new Scene(memory, memory.handle('cuvette_scene_create'), new Files(memory.module.FS, '', {}));
  }

  /* Makes the folder of the scene's files the working directory, for calls that may read the files. Returns the
   * memory. */
  in() {
    this.#memory.module.FS.chdir(this.#files.path);
    return this.#memory;
  }

  clone() {
    const address = this.#memory.handle('cuvette_scene_clone', this.at);
    this.#files.users++;
    return new Scene(this.#memory, address, this.#files);
  }

  /* value: a number, a switch, a text, or an array of numbers. */
  set(path, value) {
    const text = typeof value === 'boolean' ? (value ? 'on' : 'off') : Array.isArray(value) ? value.join(',') : value;
    this.in().check('cuvette_scene_set', this.at, path, String(text));
  }

  get(path) {
    return this.in().text('wasm_scene_get', this.at, path);
  }

  parameters() {
    return this.in().json('wasm_scene_parameters', this.at);
  }

  text() {
    return this.in().text('wasm_scene_text', this.at);
  }

  hints() {
    return this.in().json('wasm_scene_hints', this.at);
  }

  check() {
    this.in().check('cuvette_scene_check', this.at);
  }

  /* {lights, materials, solids, meshes, textures}, the names of each. */
  names() {
    return this.in().json('wasm_scene_names', this.at);
  }

  addLight(name) {
    this.in().check('cuvette_scene_add_light', this.at, name);
  }

  addMaterial(name) {
    this.in().check('cuvette_scene_add_material', this.at, name);
  }

  addSolid(name, shape, material = 0) {
    this.in().check('cuvette_scene_add_solid', this.at, name, shape, material);
  }

  addMesh(name) {
    this.in().check('cuvette_scene_add_mesh', this.at, name);
  }

  remove(name) {
    this.in().check('cuvette_scene_remove', this.at, name);
  }

  rename(name, to) {
    this.in().check('cuvette_scene_rename', this.at, name, to);
  }

  /* A snapshot of the scene for rays; lambda_nm: at one wavelength. */
  query({ lambda_nm } = {}) {
    const memory = this.in();
    const address =
      lambda_nm === undefined
        ? memory.handle('cuvette_query_create', this.at, 0)
        : memory.handle('cuvette_query_wavelength_create', this.at, lambda_nm, 0);
    return new Query(memory, address);
  }

  #ask(use, options) {
    const query = this.query(options);
    try {
      return use(query);
    } finally {
      query.destroy();
    }
  }

  trace(ray, options) {
    return this.#ask((query) => query.trace(ray), options);
  }

  fan(rule, options) {
    return this.#ask((query) => query.fan(rule), options);
  }

  /* {metrics, curves}: the scene's optics compared with theory. */
  realism() {
    return this.in().json('wasm_scene_realism', this.at);
  }

  curve(name) {
    return this.in().json('wasm_scene_curve', this.at, name);
  }

  /* The report on the scene's lens, as `cuvette lens report --json`; system: the first word of the names of its
   * solids. */
  lens(system = '') {
    return this.in().json('wasm_scene_lens', this.at, system);
  }

  /* The motion of the scene's slimes from time 0. */
  motion() {
    return new Motion(this);
  }
}
