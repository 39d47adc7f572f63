// The module in Node: the same bits as a native run, mistakes with their places, views, hands.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { basename, join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";
import { BUILT, native, SCENES, scene } from "./support.mjs";

const FRAMES = 60;
const SHIPPED = ["dam_break", "open_gas_jet", "floating_bodies", "rigid_pile", "pyramid", "rope", "soft_bodies", "water_wheel",
  "two_liquids_side_by_side"].map((name) => join(SCENES, `${name}.toml`));
/** Large scenes, and one that is periodic: fewer frames show the same. */
const [FEW, LARGE] = [8, ["everything", "closed_gas_hot", "rayleigh_taylor_2", "large_dam_break"].map((name) => join(SCENES, `${name}.toml`))];
const OWN = ["kinds.toml", "sleep.toml"].map((name) => fileURLToPath(new URL(name, import.meta.url)));

let unipbd, SceneError;

before(async () => {
  const module = await import(pathToFileURL(join(BUILT, "npm/unipbd.js")).href);
  ({ SceneError } = module);
  unipbd = await module.load();
});

test("hashes of states are those of native runs", () => {
  const parts = [[FRAMES, [...SHIPPED, ...OWN]], [FEW, LARGE]];
  const all = parts.flatMap(([frames, paths]) => compared(frames, paths));
  assert.equal(all.length, SHIPPED.length + OWN.length + LARGE.length);
  const sum = (key) => all.reduce((sum, one) => sum + one[key], 0);
  console.log(`all: ${(sum("here") / sum("native")).toFixed(1)} times native (${unipbd.simd})`);
});

/** Runs scenes here and natively, compares hashes, returns seconds. */
function compared(frames, paths) {
  const expected = native(frames, paths);
  return paths.map((path) => {
    const { hash, seconds, build } = expected.get(basename(path, ".toml"));
    const run = unipbd.open(readFileSync(path, "utf8"));
    const begin = process.cpuUsage();
    while (run.frame < frames) run.step();
    const { user, system } = process.cpuUsage(begin);
    const here = (user + system) / 1e6;
    assert.equal(run.hash, hash, path);
    run.close();
    console.log(`${basename(path)}: ${frames} frames in ${here.toFixed(2)} s, ${(here / seconds).toFixed(1)} times native (${build})`);
    return { here, native: seconds };
  });
}

test("the module has lanes and is small", () => {
  assert.equal(unipbd.simd, "simd128");
  const bytes = gzipSync(readFileSync(join(BUILT, "npm/unipbd.wasm")), { level: 9 }).length;
  console.log(`${bytes} bytes compressed`);
  assert.ok(bytes < 1 << 20);
});

test("a mistake has its line, column and hint", () => {
  const wrong = scene("dam_break").replace("density =", "densty =");
  const line = wrong.split("\n").findIndex((text) => text.startsWith("densty")) + 1;
  assert.throws(() => unipbd.open(wrong), (error) => {
    assert.ok(error instanceof SceneError);
    assert.deepEqual([error.problems[0].line, error.problems[0].column, error.problems[0].length], [line, 1, 6]);
    assert.match(error.message, /\^\^\^\^\^\^/);
    assert.match(error.problems[0].hint, /density/);
    return true;
  });
});

test("a scene whose motion is in a file is refused with what to do: there are no files", () => {
  const shaken = scene("dam_break").replace("[[liquid]]", '[shaking]\nfile = "shake.csv"\n\n[[liquid]]');
  assert.throws(() => unipbd.open(shaken), (error) => {
    assert.match(error.problems[0].message, /no files here, "shake.csv" cannot be read/);
    assert.match(error.problems[0].hint, /`table`/);
    return true;
  });
  const table = shaken.replace('file = "shake.csv"', "table = { time = [0.0, 1.0], ax = [0.0, 1.0] }");
  assert.doesNotThrow(() => unipbd.open(table).step());
});

test("views show the run, and settings change it while it goes on", () => {
  const run = unipbd.open(scene("floating_bodies"), { "liquid.water.kinematic_viscosity": 0.1 });
  assert.equal(run.positions.length, 2 * run.ids.length);
  assert.equal(run.materials.length, run.ids.length);
  assert.equal(run.poses.length, 4 * run.describe().bodies.length);
  for (let k = 0; k < 10; k++) run.step();
  const before = run.positions.slice();
  assert.equal(run.change({ "liquid.water.kinematic_viscosity": 0.2, gravity: [0, -3] }), true);
  assert.deepEqual(run.positions.slice(), before);
  run.step();
  assert.equal(run.frame, 11);
  assert.equal(run.change({ spacing: 0.1 }), false);
  assert.equal(run.frame, 0);
  assert.throws(() => run.change({ "liquid.water.densty": 1 }), SceneError);
  run.close();
  assert.throws(() => run.step(), /closed/);
});

test("a body follows the hand, and what is poured stays", () => {
  const run = unipbd.open(scene("floating_bodies"));
  assert.equal(run.grab(0.1, 2.9), null);
  const body = run.grab(0.9, 1.9);
  run.drag(1.5, 2.5);
  for (let k = 0; k < 60; k++) run.step();
  const [x, y] = run.poses.subarray(4 * body, 4 * body + 2);
  assert.ok(Math.hypot(x - 1.5, y - 2.5) < 0.25, `${x} ${y}`);
  run.release();
  const count = run.ids.length;
  const poured = run.pour(0, 3, 2.7, 0.2);
  assert.ok(poured > 30 && run.ids.length === count + poured);
  run.step();
  run.close();
});
