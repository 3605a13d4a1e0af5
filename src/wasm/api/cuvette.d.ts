/* Types of the JavaScript API; README.md in the folder above describes it. */

export type Vector = [number, number, number];
export type Value = string | number | boolean | number[];

/** Where the module is: a folder with simd128/ and plain/, or both files. */
export type Place =
  | { folder: string | URL }
  | {
      module: string | URL | ((options: object) => Promise<object>);
      wasm: string | URL | BufferSource | WebAssembly.Module;
    };

export class CuvetteError extends Error {
  readonly status: number; // 1 failure, 2 bad input, 3 busy
  readonly what: string;
  readonly remedy: string;
  readonly file: string; // '': none
  readonly line: number; // 0: none
  readonly column: number;
}

export interface Ray {
  origin: Vector;
  direction: Vector;
  reach?: number; // 0: no limit
}
export interface Pixel {
  pixel: [number, number];
}

export interface Tile {
  x0: number;
  y0: number;
  x1: number;
  y1: number;
  coarse: number; // 1: final; n: a preview with one value per n x n pixels
  width: number;
  height: number;
  srgb: Uint8ClampedArray; // RGBA, width x height
}
export interface RenderOptions {
  progress?: (fraction: number) => void;
  tile?: (tile: Tile) => void;
  signal?: AbortSignal;
  preview?: number; // 2..64
}
export interface Counters {
  camera: number;
  reflect: number;
  refract: number;
  shadow: number;
  photon: number;
  total_internal: number;
  cut_depth: number;
  cut_weight: number;
  cut_depth_throughput: Vector;
  cut_weight_throughput: Vector;
  by_depth: number[];
}
export interface Image {
  width: number;
  height: number;
  srgb: Uint8ClampedArray; // RGBA
  rgb: Float32Array; // linear, 3 per pixel
  hash: string; // of the film, 16 hex digits
  counters: Counters;
  wall_s: number;
}

export interface Parameter {
  path: string;
  value: string;
  unit: string;
  range: string;
  initial: string;
  meaning: string;
}
export interface Names {
  lights: string[];
  materials: string[];
  solids: string[];
  meshes: string[];
  textures: string[];
}
export interface FanRule {
  from: Vector;
  to: Vector;
  normal?: Vector;
  rays?: number;
  width?: number;
  spread_deg?: number;
}
export interface Fan {
  count: number;
  followed: number;
  axis: Vector;
  focus: { at: Vector; rms: number; virtual: boolean } | null;
  crossings: { ray: number; at: Vector }[];
  rays: object[];
}
export interface Metric {
  name: string;
  meaning: string;
  unit: string;
  verdict: 'pass' | 'FAIL' | 'none';
  measured: number | null;
  theory: number | null;
  error: number | null;
  tolerance: number | null;
}
/** Columns of a section: one value, or one for each record; null: none. */
export interface LensReport {
  schema: number;
  lens: string;
  sections: Record<
    string,
    {
      meaning: string;
      x?: string;
      units: Record<string, string>;
      values: Record<string, number | null | (number | null)[]>;
    }
  >;
}
export interface Curve {
  name: string;
  x: string;
  y: string;
}
export interface Hit {
  distance: number | null; // null: no hit, and only `before` is set
  before: string | null; // the names of solids; null: outside
  after?: string | null;
  solid?: string | null;
  point?: Vector;
  normal?: Vector;
  error?: number;
  face?: number;
  triangle?: number;
  copy?: number;
  slot?: number;
  u?: number;
  v?: number;
  n_before?: number;
  n_after?: number;
}
export interface Slime {
  time_s: number;
  steps: number;
  substeps: number;
  masses: number;
  held: number;
  kinetic: number;
  elastic: number;
  compression: number;
  gravity: number;
  center: Vector;
  momentum: Vector;
  volume: number;
  volume_at_rest: number;
  low: number;
  high: number;
  speed_max: number;
}
export interface AdvanceOptions {
  progress?: (fraction: number) => void;
  signal?: AbortSignal;
}

/** T, or a promise of it from a worker. */
type Later<Remote, T> = Remote extends true ? Promise<T> : T;

interface QueryOf<R> {
  cameraRay(x: number, y: number): Later<R, Ray>;
  nearest(rays: Ray[]): Later<R, Hit[]>;
  medium(point: Vector): Later<R, string | null>;
  trace(ray: Ray | Pixel): Later<R, object>; // cuvette-trace(1), JSON OUTPUT
  fan(rule: FanRule): Later<R, Fan>;
  destroy(): void;
}

interface MotionOf<R> {
  names(): Later<R, string[]>;
  state(name: string): Later<R, Slime>;
  advance(time_s: number, options?: AdvanceOptions): Promise<void>;
  pick(name: string, ray: Ray): Later<R, { distance: number; where: Vector } | null>;
  grab(name: string, ray: Ray, reach: number): Later<R, { hand: number; where: Vector } | null>;
  move(hand: number, by: Vector): Later<R, void>;
  release(hand: number): Later<R, void>;
  destroy(): void;
}

interface SceneOf<R> {
  clone(): Later<R, SceneOf<R>>;
  set(path: string, value: Value): Later<R, void>;
  get(path: string): Later<R, string>;
  parameters(): Later<R, Parameter[]>;
  text(): Later<R, string>;
  hints(): Later<R, string[]>;
  check(): Later<R, void>;
  names(): Later<R, Names>;
  addLight(name: string): Later<R, void>;
  addMaterial(name: string): Later<R, void>;
  addSolid(name: string, shape: string, material?: string): Later<R, void>;
  addMesh(name: string): Later<R, void>;
  remove(name: string): Later<R, void>;
  rename(name: string, to: string): Later<R, void>;
  query(options?: { lambda_nm?: number }): Later<R, QueryOf<R>>;
  trace(ray: Ray | Pixel, options?: { lambda_nm?: number }): Later<R, object>;
  fan(rule: FanRule, options?: { lambda_nm?: number }): Later<R, Fan>;
  realism(): Later<R, { metrics: Metric[]; curves: Curve[] }>;
  curve(name: string): Later<R, Vector[]>; // x, measured, theory
  lens(system?: string): Later<R, LensReport>;
  motion(): Later<R, MotionOf<R>>;
  destroy(): void;
}

interface EngineOf<R> {
  render(scene: SceneOf<R>, options?: RenderOptions): Promise<Image>;
  cancel(): Later<R, void>;
  destroy(): void;
}

interface CuvetteOf<R> {
  readonly version: string;
  readonly isa: 'simd128' | 'plain';
  Scene: {
    read(
      text: string | Uint8Array,
      options?: { name?: string; files?: Record<string, Uint8Array> },
    ): Later<R, SceneOf<R>>;
    create(): Later<R, SceneOf<R>>;
  };
  engine(): Later<R, EngineOf<R>>;
  random(key: [number, number], counter: [number, number, number, number]): Later<R, number[]>;
}

export type Scene = SceneOf<false>;
export type Query = QueryOf<false>;
export type Motion = MotionOf<false>;
export type Engine = EngineOf<false>;
export type Cuvette = CuvetteOf<false> & { readonly memoryBytes: number };
export type RemoteCuvette = CuvetteOf<true> & { memoryBytes(): Promise<number>; destroy(): void };

export function hasVectors(): boolean;
export function load(place: Place): Promise<Cuvette>;
/** worker: a browser's Worker on api/worker.js, of type module, or one of node:worker_threads. */
export function connect(worker: object, place: Place): Promise<RemoteCuvette>;
