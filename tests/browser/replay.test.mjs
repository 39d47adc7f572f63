// The page that `unipbd render -o NAME.html` writes, played in a headless browser.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import chromium from "@sparticuz/chromium";
import puppeteer from "puppeteer-core";

const COMMAND = process.env.UNIPBD_COMMAND;
const SCENE = `
name = "Pour </script> & float"
spacing = 0.05
duration = 1.0
[view]
min = [-0.1, -0.1]
max = [2.1, 1.6]
[[liquid]]
name = "water"
color = "#2060ff"
[[block]]
material = "water"
min = [0.0, 0.0]
max = [0.8, 0.8]
[[emitter]]
material = "water"
position = [1.8, 1.3]
direction = [-1.0, 0.0]
width = 0.2
speed = 1.0
[[tank]]
min = [0.0, 0.0]
max = [2.0, 3.0]
open = ["top"]
[[body]]
radius = 0.2
position = [1.2, 0.2]
density = 400.0
`;

let folder, browser, page;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), "unipbd-"));
  const run = (...words) => execFileSync(COMMAND, words, { cwd: folder, stdio: ["ignore", "ignore", "inherit"] });
  writeFileSync(join(folder, "pour.toml"), SCENE);
  run("pour.toml", "-q", "--fields", "density");
  run("render", "pour.mcap", "-o", "pour.html", "-q");
  run("export", "pour.mcap", "-o", ".", "--format", "csv", "-q");
  browser = await puppeteer.launch({
    args: chromium.args,
    executablePath: await chromium.executablePath(),
    headless: "shell",
    defaultViewport: { width: 900, height: 700 },
  });
  page = await browser.newPage();
  page.on("pageerror", (error) => assert.fail(error));
  await page.goto(pathToFileURL(join(folder, "pour.html")).href);
  await page.waitForFunction("window.replay");
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

const table = (name) => {
  const [head, ...rows] = readFileSync(join(folder, name), "utf8").trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(head.map((key, k) => [key, row[k]])));
};

test("every particle is where the log has it, to half a quantum", async () => {
  const played = await page.evaluate(() => {
    const { frames, head } = window.replay;
    const places = frames.map((frame) => [0, 1].map((axis) =>
      Array.from(frame.places[axis], (place) => place * head.quantum + head.middle[axis])));
    return { places, times: head.times, quantum: head.quantum };
  });
  const byTime = new Map();
  for (const row of table("particles.csv")) {
    const time = Number(row.time).toFixed(4);
    byTime.set(time, [...(byTime.get(time) ?? []), row]);
  }
  assert.ok(played.times.length > 25 && played.quantum < 0.05 / 15);
  let most = 0;
  played.times.forEach((time, number) => {
    const rows = byTime.get(time.toFixed(4));
    const [x, y] = played.places[number];
    assert.equal(x.length, rows.length, `particles at ${time} s`);
    rows.forEach((row, k) => {
      most = Math.max(most, Math.abs(x[k] - row.x), Math.abs(y[k] - row.y));
    });
  });
  assert.ok(most <= 0.51 * played.quantum, `${most} m off`);
  const counts = played.places.map(([x]) => x.length);
  assert.ok(counts.at(-1) > counts[0], "the emitter pours");
});

const pixels = (time) => page.evaluate((time) => {
  window.replay.show(time);
  const canvas = document.getElementById("view");
  const { data, width, height } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  const found = { water: 0, waterX: 0, body: 0, bodyX: 0 };
  for (let k = 0; k < width * height; k++) {
    const [red, green, blue] = data.subarray(4 * k, 4 * k + 3);
    if (blue > 180 && red < 110) { found.water++; found.waterX += (k % width) / width; }
    if (red > 200 && green > 140 && blue < 90) { found.body++; found.bodyX += (k % width) / width; }
  }
  return { water: found.water, waterX: found.waterX / found.water, body: found.body, bodyX: found.bodyX / found.body };
}, time);

test("the picture shows the water run and the disc where it is", async () => {
  const [start, end] = [await pixels(0), await pixels(1)];
  assert.ok(start.water > 20000 && start.body > 5000, JSON.stringify(start));
  assert.ok(end.waterX > start.waterX + 0.05, JSON.stringify([start, end]));
  const disc = table("bodies.csv").filter((row) => Number(row.time) === 0)[0];
  // The view is 2.2 m wide and fills 900 pixels.
  assert.ok(Math.abs(start.bodyX - (Number(disc.x) + 0.1) / 2.2) < 0.01, `${start.bodyX}`);
});

test("keys, colours and the seek bar work", async () => {
  await page.select("#color", "speed");
  assert.match(await page.$eval("#high", (element) => element.textContent), /m\/s/);
  assert.deepEqual(await page.$$eval("#color option", (all) => all.map((one) => one.value)),
    ["material", "speed", "density error"]);
  await page.evaluate(() => window.replay.show(0.5));
  const label = () => page.$eval("#time", (element) => element.textContent);
  assert.equal(await label(), "0.50 s");
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("ArrowRight");
  assert.equal(await label(), "0.53 s");
  await page.click("#play");
  await new Promise((done) => setTimeout(done, 300));
  assert.notEqual(await label(), "0.53 s");
  assert.equal(await page.title(), "Pour </script> & float");
});

test("the page is small", () => {
  assert.ok(statSync(join(folder, "pour.html")).size < 400_000);
});
