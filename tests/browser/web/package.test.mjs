// The npm package: packed, installed into an empty folder, used from there, its types checked.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { BUILT } from "./support.mjs";

const SCENE = `spacing = 0.1\n[[liquid]]\nname = "water"\n[[block]]\nmaterial = "water"\nmin = [0.0, 0.0]\nmax = [1.0, 1.0]\n`;
let folder;
const run = (command, ...words) => execFileSync(command, words, { cwd: folder, encoding: "utf8" });

before(() => {
  folder = mkdtempSync(join(tmpdir(), "unipbd-"));
  const [{ filename, files }] = JSON.parse(run("npm", "pack", "--json", join(BUILT, "npm")));
  const names = files.map(({ path }) => path).sort();
  assert.deepEqual(names, ["LICENSE-APACHE", "LICENSE-MIT", "README.md", "package.json", "unipbd.d.ts", "unipbd.js", "unipbd.wasm"]);
  writeFileSync(join(folder, "package.json"), `{ "type": "module" }`);
  run("npm", "install", "--offline", "--silent", "--no-audit", "--no-fund", `./${filename}`);
});

after(() => rmSync(folder, { recursive: true, force: true }));

test("a program that has the package alone runs a scene", () => {
  writeFileSync(join(folder, "use.js"), `
import { load } from "unipbd";
const run = (await load()).open(${JSON.stringify(SCENE)});
while (run.frame < 5) run.step();
console.log(run.frame, run.ids.length, run.diagnostics().count_liquid, run.hash);
`);
  assert.match(run(process.execPath, "use.js"), /^5 100 100 [0-9a-f]{16}\n$/);
});

test("the program of its page runs", () => {
  const page = readFileSync(join(BUILT, "npm/README.md"), "utf8");
  writeFileSync(join(folder, "page.js"), /```js\n([^]*?)```/.exec(page)[1]);
  assert.match(run(process.execPath, "page.js"), /^Float32Array\(1600\) /);
});

test("its types fit their use", () => {
  writeFileSync(join(folder, "use.ts"), `
import { load, SceneError, type Description, type Simulation } from "unipbd";
const unipbd = await load(new URL("unipbd.wasm", import.meta.url));
const run: Simulation = unipbd.open("", { "liquid.water.density": 900, gravity: [0, -1] });
const about: Description = run.describe();
const x: number = run.positions[0] + run.poses[1] + about.view.min[0];
const body: number | null = run.grab(0, 1);
try { run.step(); } catch (error) { if (error instanceof SceneError) console.log(error.problems[0].line, x, body); }
// @ts-expect-error: frames are read only
run.frame = 1;
`);
  const compiler = fileURLToPath(new URL("../node_modules/typescript/bin/tsc", import.meta.url));
  const options = ["--noEmit", "--strict", "--target", "es2022", "--module", "nodenext", "--lib", "es2022,dom"];
  run(process.execPath, compiler, ...options, "use.ts");
});
