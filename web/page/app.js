// The page: wires controls, worker, stage, plots and editor together.
import { Editor } from "./editor.js";
import { Plot } from "./plots.js";
import { putSliders, shown, slidersOf } from "./sliders.js";
import { ramp, Stage } from "./stage.js";

const element = (id) => document.getElementById(id);
const stage = new Stage(element("stage"));
const editor = new Editor(element("text"), element("gutter"), element("mistakes"));
const worker = new Worker("worker.js", { type: "module" });
const send = (type, more = {}) => worker.postMessage({ type, ...more });

let schema = null;
let frame = null;
let playing = true;
/** Whether the scene is another one: where a slider makes it start anew, controls stay as they are. */
let fresh = true;

const energy = new Plot(element("energy"), element("energy-label"), "J", [
  { name: "kinetic", color: "#6fb1f0", value: (numbers) => numbers.kinetic_energy },
  { name: "potential above its lowest", color: "#f0b86f", value: (numbers) => numbers.potential_energy, relative: true },
]);
const compression = new Plot(element("compression"), element("compression-label"), "%", [
  { name: "mean compression", color: "#8fd694", value: (numbers) => 100 * numbers.density_error_mean },
]);

const arrivals = {
  async ready({ version, simd, schema: known }) {
    schema = known;
    element("about").textContent = `${version}, ${simd}, one thread`;
    const scenes = await (await fetch("scenes/index.json")).json();
    element("scene").replaceChildren(...scenes.map(({ file, title }) => new Option(title, file)));
    await choose(decodeURIComponent(location.hash.slice(1)) || "dam_break");
  },
  began({ scene, temperatures }) {
    element("notice").textContent = "";
    editor.clear();
    stage.begin(scene);
    [energy, compression].forEach((plot) => plot.clear());
    if (!fresh) return;
    fresh = false;
    frame = null;
    document.title = `${scene.name || "scene"} - unipbd`;
    putSliders(element("sliders"), slidersOf(schema, scene.scene), (settings) => send("change", { settings }));
    const pourable = scene.materials.map(({ name, phase }, number) => ({ name, phase, number }));
    const shownOnes = pourable.filter(({ phase }) => ["liquid", "gas", "smoke"].includes(phase));
    const first = shownOnes.find(({ phase }) => phase === "liquid") ?? shownOnes[0];
    const options = shownOnes.map(({ name, number }) => new Option(name, number));
    element("pour").replaceChildren(...options, new Option("nothing", -1));
    element("pour").value = first?.number ?? -1;
    const colors = ["material", "speed", "density", ...(temperatures ? ["temperature"] : [])];
    element("color").replaceChildren(...colors.map((color) => new Option(color)));
    recolor();
    send("play", { on: playing });
  },
  frame({ frame: next }) {
    const again = next.number === frame?.number;
    frame = next;
    requestAnimationFrame(() => {
      redraw();
      send("drawn");
    });
    if (!again) [energy, compression].forEach((plot) => plot.add(frame.diagnostics));
  },
  mistakes({ text, problems }) {
    editor.mark(text, problems);
    if (problems.length > 0) {
      element("source").open = true;
      element("source").scrollIntoView({ block: "nearest" });
    } else {
      element("notice").textContent = text;
    }
    setPlaying(false);
  },
  failed({ text }) {
    element("notice").textContent = text;
    setPlaying(false);
  },
  reached({ frame: number, hash }) {
    reaching?.({ frame: number, hash });
  },
};
worker.onmessage = ({ data }) => arrivals[data.type](data);
worker.onerror = (event) => arrivals.failed({ text: `The page's worker failed: ${event.message}` });

async function choose(file) {
  const response = await fetch(`scenes/${file}.toml`);
  if (!response.ok) return arrivals.failed({ text: `There is no scene ${file}.` });
  element("scene").value = file;
  history.replaceState(null, "", `#${encodeURIComponent(file)}`);
  editor.text = await response.text();
  playing = true;
  open();
}

function open() {
  fresh = true;
  frame = null;
  setPlaying(playing);
  send("open", { text: editor.text, settings: {} });
}

function setPlaying(on) {
  playing = on;
  element("play").textContent = on ? "\u275a\u275a" : "\u25b6";
}

function recolor() {
  const what = element("color").value;
  stage.show(what);
  send("show", { what });
  const pen = element("ramp").getContext("2d");
  ramp(what).forEach((color, k) => {
    pen.fillStyle = color;
    pen.fillRect(k, 0, 1, 1);
  });
}

function redraw() {
  if (!frame) return;
  stage.draw(frame);
  element("time").textContent = `${frame.time.toFixed(2)} s`;
  element("legend").style.display = frame.range ? "flex" : "none";
  if (!frame.range) return;
  const percent = element("color").value === "density";
  const unit = { speed: "m/s", density: "%" }[element("color").value] ?? "";
  const [low, high] = frame.range.map((value) => shown(percent ? 100 * value : value));
  element("low").textContent = low;
  element("high").textContent = `${high} ${unit}`;
}

element("scene").addEventListener("change", (event) => choose(event.target.value));
element("run").addEventListener("click", () => {
  playing = true;
  open();
});
element("play").addEventListener("click", () => {
  setPlaying(!playing);
  send("play", { on: playing });
});
element("step").addEventListener("click", () => {
  setPlaying(false);
  send("play", { on: false });
  send("step");
});
element("restart").addEventListener("click", open);
element("color").addEventListener("change", recolor);
new ResizeObserver(() => {
  stage.fit();
  redraw();
}).observe(element("stage"));

const canvas = element("stage");
canvas.addEventListener("pointerdown", (event) => {
  if (!frame || event.button !== 0) return;
  canvas.setPointerCapture(event.pointerId);
  send("press", { ...stage.place(event), material: Number(element("pour").value) });
});
canvas.addEventListener("pointermove", (event) => {
  if (frame && canvas.hasPointerCapture(event.pointerId)) send("move", stage.place(event));
});
for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, () => send("lift"));

// For tests: what is shown, and the hash of the state at a frame.
let reaching = null;
window.unipbd = {
  get frame() {
    return frame?.number ?? null;
  },
  get particles() {
    return frame?.materials.length ?? 0;
  },
  reach(number) {
    setPlaying(false);
    send("play", { on: false });
    return new Promise((done) => {
      reaching = done;
      send("reach", { frame: number });
    });
  },
};
