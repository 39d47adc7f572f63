// unipbd as a module: scenes in, positions and outlines out. unipbd.d.ts has the types.

const COLUMNS = [
  ["positions", Float32Array],
  ["velocities", Float32Array],
  ["densityErrors", Float32Array],
  ["temperatures", Float32Array],
  ["ids", Uint32Array],
  ["materials", Uint16Array],
  ["poses", Float64Array],
  ["outlines", Float32Array],
];

/** A scene that cannot be read, or a run that cannot go on. */
export class SceneError extends Error {
  constructor({ text, problems }) {
    super(text);
    this.name = "SceneError";
    this.problems = problems;
  }
}

/** Loads the module: from the file beside this one, another address, or bytes. */
export async function load(source = new URL("unipbd.wasm", import.meta.url)) {
  return new Unipbd((await instantiate(await source)).exports);
}

async function instantiate(source) {
  if (source instanceof WebAssembly.Module) return WebAssembly.instantiate(source);
  if (ArrayBuffer.isView(source) || source instanceof ArrayBuffer) return (await WebAssembly.instantiate(source)).instance;
  const address = new URL(source, import.meta.url);
  if (address.protocol === "file:") {
    const { readFile } = await import("node:fs/promises");
    return (await WebAssembly.instantiate(await readFile(address))).instance;
  }
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status} ${response.statusText}`);
  return (await WebAssembly.instantiate(await response.arrayBuffer())).instance;
}

class Unipbd {
  #exports;

  constructor(exports) {
    this.#exports = exports;
    exports.unipbd_about();
    Object.assign(this, answer(exports));
  }

  open(text, settings = {}) {
    return new Simulation(this.#exports, text, settings);
  }
}

/** A scene that runs. */
class Simulation {
  #exports;
  #run;

  constructor(exports, text, settings) {
    this.#exports = exports;
    this.#run = withText(exports, [text, lines(settings)], exports.unipbd_open);
    if (this.#run === 0) throw new SceneError(answer(exports));
  }

  get frame() {
    return this.#exports.unipbd_frame(this.#open());
  }

  get time() {
    return this.#exports.unipbd_time(this.#open());
  }

  get hash() {
    return BigInt.asUintN(64, this.#exports.unipbd_hash(this.#open())).toString(16).padStart(16, "0");
  }

  step() {
    return this.#orError(this.#exports.unipbd_step(this.#open()));
  }

  change(settings) {
    const change = (place, bytes) => this.#exports.unipbd_change(this.#open(), place, bytes);
    return this.#orError(withText(this.#exports, [lines(settings)], change)) === 1;
  }

  describe() {
    this.#exports.unipbd_describe(this.#open());
    return answer(this.#exports);
  }

  diagnostics() {
    this.#exports.unipbd_diagnostics(this.#open());
    return answer(this.#exports);
  }

  pour(material, x, y, radius) {
    return this.#orError(this.#exports.unipbd_pour(this.#open(), material, x, y, radius));
  }

  grab(x, y) {
    const body = this.#exports.unipbd_grab(this.#open(), x, y);
    return body < 0 ? null : body;
  }

  drag(x, y) {
    this.#exports.unipbd_drag(this.#open(), x, y);
  }

  release() {
    this.#exports.unipbd_release(this.#open());
  }

  close() {
    if (this.#run !== 0) this.#exports.unipbd_close(this.#run);
    this.#run = 0;
  }

  #open() {
    if (this.#run === 0) throw new Error("the simulation is closed");
    return this.#run;
  }

  #orError(value) {
    if (value < 0) throw new SceneError(answer(this.#exports));
    return value;
  }

  column(number) {
    const kind = COLUMNS[number][1];
    // The length comes first: a column that is computed may make the memory grow.
    const length = this.#exports.unipbd_column_length(this.#open(), number);
    const place = this.#exports.unipbd_column(this.#open(), number);
    return length === 0 ? new kind() : new kind(this.#exports.memory.buffer, place, length);
  }
}

COLUMNS.forEach(([name], number) => {
  Object.defineProperty(Simulation.prototype, name, {
    get() {
      return this.column(number);
    },
  });
});

/** Overrides as the scene reader takes them, one a line. */
function lines(settings) {
  return Object.entries(settings).map(([key, value]) => `${key}=${JSON.stringify(value)}`).join("\n");
}

function answer(exports) {
  const bytes = new Uint8Array(exports.memory.buffer, exports.unipbd_answer(), exports.unipbd_answer_bytes());
  return JSON.parse(new TextDecoder().decode(bytes));
}

/** Calls a function with the places and lengths of texts. */
function withText(exports, texts, call) {
  const encoded = texts.map((text) => new TextEncoder().encode(text));
  const places = encoded.map((bytes) => exports.unipbd_allocate(bytes.length));
  encoded.forEach((bytes, k) => new Uint8Array(exports.memory.buffer, places[k], bytes.length).set(bytes));
  try {
    return call(...encoded.flatMap((bytes, k) => [places[k], bytes.length]));
  } finally {
    encoded.forEach((bytes, k) => exports.unipbd_free(places[k], bytes.length));
  }
}
