// The solver's own thread: it takes commands of the page, steps in step with the clock, and sends frames to draw.
import { load } from "./unipbd.js";
import { Shades } from "./shades.js";

/** Discs that a pointer pours [spacings]. */
const POUR_RADIUS = 3.5;
/** Frames that a slow machine may fall behind the clock before it stops to catch up. */
const MOST_BEHIND = 2;

let unipbd, run, scene;
let playing = false;
let due = 0;
let waiting = false;
let pointer = null;
const shades = new Shades();

const say = (type, more = {}, moved = []) => postMessage({ type, ...more }, moved);

const commands = {
  open({ text, settings }) {
    run?.close();
    run = null;
    run = unipbd.open(text, settings);
    began();
  },
  change({ settings }) {
    if (run.change(settings)) send();
    else began();
  },
  play({ on }) {
    playing = on;
    due = performance.now();
    wake();
  },
  step() {
    advance();
    send();
  },
  show({ what }) {
    shades.show(what);
    send();
  },
  press({ x, y, material }) {
    const body = run.grab(x, y);
    pointer = { x, y, material, pours: body === null };
    wake();
  },
  move({ x, y }) {
    if (!pointer) return;
    Object.assign(pointer, { x, y });
    if (!pointer.pours) run.drag(x, y);
  },
  lift() {
    pointer = null;
    run.release();
  },
  drawn() {
    waiting = false;
    wake();
  },
  // For tests: runs to a frame and tells the hash of the state there.
  reach({ frame }) {
    while (run.frame < frame) advance();
    send();
    say("reached", { frame: run.frame, hash: run.hash });
  },
};

function began() {
  scene = run.describe();
  shades.begin();
  pointer = null;
  due = performance.now();
  say("began", { scene, temperatures: run.temperatures.length > 0 });
  send();
}

function advance() {
  if (pointer?.pours && pointer.material >= 0) {
    run.pour(pointer.material, pointer.x, pointer.y, POUR_RADIUS * scene.spacing);
  }
  run.step();
}

function send() {
  const { shade, range } = shades.of(run);
  const frame = {
    number: run.frame,
    time: run.time,
    positions: run.positions.slice(),
    materials: run.materials.slice(),
    outlines: run.outlines.slice(),
    shade,
    range,
    diagnostics: run.diagnostics(),
  };
  waiting = true;
  say("frame", { frame }, [frame.positions.buffer, frame.materials.buffer, frame.outlines.buffer, shade.buffer]);
}

// The next frame comes when the last one is drawn and its time has come.
let timer = null;
function wake() {
  if (!run || !playing || waiting || timer !== null) return;
  timer = setTimeout(tick, Math.max(0, due - performance.now()));
}

function tick() {
  timer = null;
  if (!run || !playing || waiting) return;
  guard(() => {
    const frame = 1000 * scene.frameTime;
    due = Math.max(due + frame, performance.now() - MOST_BEHIND * frame);
    advance();
    send();
  });
}

function guard(work) {
  try {
    work();
  } catch (error) {
    playing = false;
    if (error.problems) say("mistakes", { text: error.message, problems: error.problems });
    else restart(error);
  }
}

/** The module is of no use after a fault of its own: a fresh one takes its place. */
async function restart(error) {
  run = null;
  say("failed", { text: `The solver stopped: ${error.message}. Start anew or choose another scene.` });
  unipbd = await load();
}

onmessage = ({ data }) => {
  if (data.type === "open" || run) guard(() => commands[data.type](data));
};

load().then(
  (loaded) => {
    unipbd = loaded;
    say("ready", { version: unipbd.version, simd: unipbd.simd, schema: unipbd.schema });
  },
  (error) => say("failed", { text: `The module could not be loaded: ${error.message}` }),
);
