// The page, served from a folder of static files, in a headless browser.
import assert from "node:assert/strict";
import { createServer } from "node:http";
import { mkdirSync, readFileSync } from "node:fs";
import { extname, join } from "node:path";
import { after, before, test } from "node:test";
import chromium from "@sparticuz/chromium";
import puppeteer from "puppeteer-core";
import { BUILT, native, SCENES, scene } from "./support.mjs";

const FRAMES = 30;
const RUN = ["dam_break", "rope", "soft_bodies", "water_wheel", "pyramid"];
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".wasm": "application/wasm" };
/** Where pictures go, for those who want to look. */
const PICTURES = process.env.UNIPBD_PICTURES;

const here = process.platform === "linux" && process.arch === "x64";
const skip = here ? false : "the browser of the npm registry is for Linux on x86-64";
const faults = [];
let server, browser, page;

before(async () => {
  if (!here) return;
  server = createServer((request, response) => {
    const path = new URL(request.url, "http://localhost").pathname.replace(/\/$/, "/index.html");
    try {
      const body = readFileSync(join(BUILT, "web", path));
      response.writeHead(200, { "content-type": TYPES[extname(path)] ?? "text/plain" }).end(body);
    } catch {
      response.writeHead(404).end();
    }
  });
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  browser = await puppeteer.launch({
    args: chromium.args,
    executablePath: await chromium.executablePath(),
    headless: "shell",
    defaultViewport: { width: 1200, height: 760 },
  });
  page = await browser.newPage();
  // Slow machines take their time.
  page.setDefaultTimeout(180_000);
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  await started();
});

after(async () => {
  await browser?.close();
  server?.close();
});

const started = () => page.waitForFunction(() => document.title.includes(" - ") && window.unipbd.frame !== null);
const text = (id) => page.$eval(`#${id}`, (element) => element.textContent);

async function choose(name) {
  await page.evaluate((name) => {
    document.title = "";
    const list = document.getElementById("scene");
    list.value = name;
    list.dispatchEvent(new Event("change"));
  }, name);
  await started();
}

async function picture(name) {
  if (!PICTURES) return;
  mkdirSync(PICTURES, { recursive: true });
  await page.screenshot({ path: join(PICTURES, `${name}.png`) });
}

test(`five scenes have the hashes of native runs after ${FRAMES} frames`, { skip }, async () => {
  const expected = native(FRAMES, RUN.map((name) => join(SCENES, `${name}.toml`)));
  for (const name of RUN) {
    await choose(name);
    // A chosen scene runs by itself.
    await page.click("#play");
    await page.click("#restart");
    const reached = await page.evaluate((frame) => window.unipbd.reach(frame), FRAMES);
    assert.deepEqual(reached, { frame: FRAMES, hash: expected.get(name).hash }, name);
    await new Promise((done) => setTimeout(done, 200));
    await picture(name);
  }
  assert.deepEqual(faults, []);
});

/** How many pixels have a colour, and where their middle is, as parts of width and height. */
const seen = (low, high) => page.evaluate((low, high) => {
  const canvas = document.getElementById("stage");
  const { data, width, height } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let [count, x, y] = [0, 0, 0];
  for (let k = 0; k < width * height; k++) {
    if ([0, 1, 2].some((part) => data[4 * k + part] < low[part] || data[4 * k + part] > high[part])) continue;
    count++;
    x += (k % width) / width;
    y += Math.floor(k / width) / height;
  }
  return { count, x: x / count, y: y / count };
}, low, high);
const blue = () => seen([0, 0, 150], [100, 255, 255]);
const orange = () => seen([200, 140, 0], [255, 190, 100]);

test("the picture shows water that runs, and pauses", { skip }, async () => {
  await choose("dam_break");
  const start = await blue();
  assert.ok(start.count > 10000, JSON.stringify(start));
  await page.waitForFunction(() => parseFloat(document.getElementById("time").textContent) > 0.6);
  await page.click("#play");
  await new Promise((done) => setTimeout(done, 300));
  const [later, time] = [await blue(), await text("time")];
  assert.ok(later.x > start.x + 0.05, JSON.stringify([start, later]));
  await new Promise((done) => setTimeout(done, 300));
  assert.equal(await text("time"), time, "paused");
  await page.click("#step");
  await page.waitForFunction((time) => document.getElementById("time").textContent !== time, {}, time);
  assert.match(await text("energy-label"), /kinetic .* J/);
});

test("colours, sliders and the pointer act on the run", { skip }, async () => {
  await choose("floating_bodies");
  await page.select("#color", "speed");
  await page.waitForFunction(() => /m\/s/.test(document.getElementById("high").textContent));
  await page.select("#color", "density");
  await page.waitForFunction(() => /2 %/.test(document.getElementById("high").textContent));
  await picture("density");
  await page.select("#color", "material");
  const names = await page.$$eval("#sliders input", (all) => all.map((one) => one.name));
  for (const name of ["gravity", "liquid.0.density", "liquid.0.kinematic_viscosity", "body.0.density"]) {
    assert.ok(names.includes(name), `${name} in ${names}`);
  }
  const particles = () => page.evaluate(() => window.unipbd.particles);
  const before = await particles();
  await page.$eval("#sliders input[name=gravity]", (input) => {
    input.value = 5;
    input.dispatchEvent(new Event("input"));
    input.dispatchEvent(new Event("change"));
  });
  // Gravity upwards, while the run goes on.
  const start = parseFloat(await text("time"));
  await page.waitForFunction((until) => parseFloat(document.getElementById("time").textContent) > until, {}, start + 0.7);
  await picture("upwards");
  await choose("floating_bodies");
  const box = await (await page.$("#stage")).boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.3 * box.height);
  await page.mouse.down();
  await page.waitForFunction(() => parseFloat(document.getElementById("time").textContent) > 0.5);
  await page.mouse.up();
  await page.click("#play");
  await picture("poured");
  const after = await particles();
  assert.ok(after > before + 20, `${before} ${after}`);

  await choose("floating_bodies");
  const float = await orange();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(float.x, float.y));
  await page.mouse.down();
  await page.mouse.move(...at(float.x + 0.2, float.y - 0.2), { steps: 5 });
  await page.waitForFunction(() => parseFloat(document.getElementById("time").textContent) > 1.2);
  const lifted = await orange();
  await picture("dragged");
  await page.mouse.up();
  assert.ok(Math.hypot(lifted.x - float.x - 0.2, lifted.y - float.y + 0.2) < 0.05, JSON.stringify([float, lifted]));
  assert.deepEqual(faults, []);
});

test("a mistake in a pasted scene is shown at its line", { skip }, async () => {
  await page.evaluate(() => { document.getElementById("source").open = true; });
  const wrong = scene("dam_break").replace("density =", "densty =");
  const line = wrong.split("\n").findIndex((text) => text.startsWith("densty")) + 1;
  const paste = (wrong) => page.evaluate((wrong) => {
    const text = document.getElementById("text");
    text.value = wrong;
    text.dispatchEvent(new Event("input"));
    document.getElementById("mistakes").textContent = "";
    document.getElementById("run").click();
  }, wrong);
  await paste(wrong);
  await page.waitForFunction(() => document.getElementById("mistakes").textContent !== "");
  assert.match(await text("mistakes"), new RegExp(`scene.toml:${line}:1[^]*\\^{6}[^]*did you mean`));
  assert.deepEqual(await page.$$eval("#gutter .wrong", (all) => all.map((one) => one.textContent)), [String(line)]);
  const selected = await page.$eval("#text", (one) => one.value.slice(one.selectionStart, one.selectionEnd));
  assert.equal(selected, "densty");
  await picture("mistake");
  await page.evaluate(() => { document.title = ""; });
  await paste(scene("dam_break"));
  await started();
  assert.equal(await text("mistakes"), "");
  assert.deepEqual(faults, []);
});

test("it fits a phone, and a finger pours", { skip }, async () => {
  await page.setViewport({ width: 390, height: 844, deviceScaleFactor: 2, isMobile: true, hasTouch: true });
  await page.reload();
  await started();
  await choose("dam_break");
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `${wide} wide`);
  const box = await (await page.$("#stage")).boundingBox();
  const before = await page.evaluate(() => window.unipbd.particles);
  const touch = await page.touchscreen.touchStart(box.x + 0.7 * box.width, box.y + 0.4 * box.height);
  await page.waitForFunction((before) => window.unipbd.particles > before, {}, before);
  await touch.end();
  await picture("phone");
  assert.deepEqual(faults, []);
});
