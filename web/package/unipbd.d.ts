/** A mistake of a scene, with its place in the text. */
export interface Problem {
  /** Line, from 1. */
  line: number;
  /** Column in characters, from 1. */
  column: number;
  /** How many characters are at fault. */
  length: number;
  /** Path of the key, such as `emitter[0].position`; empty for syntax errors. */
  key: string;
  message: string;
  hint: string | null;
}

/** A scene that cannot be read, or a run that cannot go on; the message is what a terminal would show. */
export class SceneError extends Error {
  problems: Problem[];
}

/** Overrides of keys of a scene, such as `{ "liquid.water.viscosity": 2, gravity: [0, -1.6] }`. */
export type Settings = Record<string, number | string | boolean | number[]>;

export interface Material {
  name: string;
  phase: "liquid" | "gas" | "smoke" | "rigid" | "solid";
  /** Rest density [kg/m^2]. */
  density: number;
  /** Red, green, blue, 0 to 255. */
  color: [number, number, number];
}

export interface Description {
  name: string;
  description: string;
  /** Rest distance of particles [m]. */
  spacing: number;
  /** [s] */
  duration: number;
  /** Length of a frame [s]. */
  frameTime: number;
  /** Corners of the part of the world to show [m]. */
  view: { min: [number, number]; max: [number, number] };
  materials: Material[];
  /** Walls as lines [m]. */
  walls: { points: [number, number][]; closed: boolean }[];
  /** Outlines in body coordinates [m]; a disc has a radius instead. */
  bodies: { name: string; radius: number; outline: [number, number][]; mass: number; fixed: boolean }[];
  /** The keys of the scene file, and overrides under `set`. */
  scene: Record<string, unknown>;
}

/**
 * A scene that runs. Columns are views of the module's memory: they hold until the next call, so copy what you keep.
 * Their rows are particles, in an order that changes from frame to frame; ids are stable.
 */
export interface Simulation {
  /** Frames done. */
  readonly frame: number;
  /** Simulated time [s]. */
  readonly time: number;
  /** Hash of the state, 16 hexadecimal digits: the same as that of a native run. */
  readonly hash: string;
  /** x, y of each particle [m]. */
  readonly positions: Float32Array;
  /** x, y of each particle [m/s]. */
  readonly velocities: Float32Array;
  /** Density over rest density, less one. */
  readonly densityErrors: Float32Array;
  /** Empty where no material has one. */
  readonly temperatures: Float32Array;
  readonly ids: Uint32Array;
  /** Numbers of materials in the description. */
  readonly materials: Uint16Array;
  /** Of each body: x, y [m], angle [rad], and 1, or 0 for one that was taken away. */
  readonly poses: Float64Array;
  /**
   * Of each body: the number of corners, then theirs in the world [m]. A disc has 1 corner, its centre, then radius [m]
   * and angle [rad]; a body that was taken away has 0.
   */
  readonly outlines: Float32Array;
  /** Advances by one frame; returns its substeps. */
  step(): number;
  /** Replaces all overrides; tells whether the run went on from where it was, or starts anew. */
  change(settings: Settings): boolean;
  describe(): Description;
  /** The columns of docs/diagnostics.md. */
  diagnostics(): Record<string, number | string>;
  /** Fills the free places of a disc [m] with a material; returns the number of particles. */
  pour(material: number, x: number, y: number, radius: number): number;
  /** Takes hold of the body at a point [m]; returns its number. */
  grab(x: number, y: number): number | null;
  /** Moves the hand to a point [m]: the body follows by a spring. */
  drag(x: number, y: number): void;
  release(): void;
  /** Gives its memory back. */
  close(): void;
}

export interface Unipbd {
  readonly version: string;
  /** The instruction set in use: `simd128`. */
  readonly simd: string;
  /** The JSON schema of scene files. */
  readonly schema: Record<string, unknown>;
  /** Reads a scene file and builds it. Throws a `SceneError`. */
  open(text: string, settings?: Settings): Simulation;
}

/** Loads the module: from `unipbd.wasm` beside the script, another address, or bytes. */
export function load(source?: string | URL | BufferSource | WebAssembly.Module): Promise<Unipbd>;
