// The report's page in headless Chromium: node page_test.mjs LATERNA NODE_MODULES CHROMIUM SOURCE SCRATCH
// It loads with no console error and no request, its numbers are the data's, every figure draws, the
// slider moves. A failure leaves a screenshot in SCRATCH; with LATERNA_SCREENSHOTS=1 all are kept, for looking at.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, readFileSync, readdirSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { gather, gatherStored } from "./samples.mjs";

const [laterna, modules, chromiumPath, source, scratch] = process.argv.slice(2);
const { chromium } = createRequire(join(modules, "x.js"))("playwright-core");
const screenshots = process.env.LATERNA_SCREENSHOTS === "1";
rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });
const keep = (page, name) => page.screenshot({ path: join(scratch, name), fullPage: true });
const flags = [
  "--no-sandbox",
  "--disable-dev-shm-usage",
  "--disable-gpu-compositing", // WebGL is drawn by the processor; the page need not be
  "--disable-background-networking",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist",
];

// A page whose every complaint and request is kept.
async function watched(browser) {
  const page = await browser.newPage({ viewport: { width: 760, height: 600 } });
  page.setDefaultTimeout(100000); // a machine at work on other things is slow, not wrong
  const complaints = [];
  const isBad = (message) => ["error", "warning"].includes(message.type()) && !message.text().includes("GPU stall");
  const isOwn = (url) =>
    /^(data|blob):/.test(url) || ["page", "static", "stored"].some((own) => url.endsWith(`${scratch}/${own}.html`));
  page.on("console", (message) => isBad(message) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => isOwn(request.url()) || complaints.push("request " + request.url()));
  return { page, complaints };
}

async function open(page, name) {
  await page.goto("file://" + join(scratch, name));
  await page.waitForTimeout(300); // the 3D view draws with the first frame
}

async function numbersEqual(page, data) {
  const shown = await page.$$eval("data", (all) => all.map((e) => [JSON.parse(e.dataset.path), e.value, e.textContent]));
  assert.ok(shown.length > 100, `${shown.length} numbers on the page`);
  for (const [path, value, text] of shown) {
    const truth = path.reduce((inner, key) => inner[key], data);
    assert.equal(Number(value), truth, path.join("."));
    assert.ok(Math.abs(Number(text) - truth) <= 5.1e-4 * Math.abs(truth), `${path.join(".")}: ${text} for ${truth}`); // four digits
  }
}

async function figuresDraw(page, least) {
  const figures = await page.$$eval("figure [role=img]", (all) =>
    all
      .filter((e) => e.tagName !== "CANVAS")
      .map((e) => ({
        name: e.getAttribute("aria-label"),
        marks: e.querySelectorAll("path, circle, rect, line").length,
        bad: /NaN|undefined|Infinity/.test(e.outerHTML),
      })),
  );
  assert.ok(figures.length >= least, `${figures.length} figures`);
  for (const f of figures) {
    assert.ok(f.name && !f.name.includes("“”"), `a figure without a name: ${f.name}`);
    assert.ok(f.marks >= 3, `${f.name}: ${f.marks} marks`);
    assert.ok(!f.bad, `${f.name}: NaN`);
  }
}

async function rigDraws(page, selector) {
  const colours = await page.$eval(selector, (canvas) => {
    const copy = Object.assign(document.createElement("canvas"), { width: 200, height: 112 }),
      context = copy.getContext("2d");
    context.drawImage(canvas, 0, 0, 200, 112);
    return new Set(new Uint32Array(context.getImageData(0, 0, 200, 112).data.buffer)).size;
  });
  assert.ok(colours > 50, `the rig has ${colours} colours`);
}

async function sliderMoves(page) {
  const state = () =>
    page.$eval("figure.leaf", (f) => [
      f.querySelector("img").src,
      f.querySelector("img").alt,
      f.querySelector("output").textContent,
    ]);
  const before = await state();
  await page.focus("input[type=range]");
  await page.keyboard.press("ArrowLeft");
  const after = await state();
  for (let k = 0; k < 3; ++k) assert.notEqual(before[k], after[k]);
}

async function rigTurns(page) {
  const picture = () => page.$eval("canvas.rig", (canvas) => canvas.toDataURL());
  const before = await picture();
  await page.focus("canvas.rig");
  await page.keyboard.press("ArrowLeft");
  const turned = await picture();
  assert.notEqual(before, turned);
  const box = await (await page.$("canvas.rig")).boundingBox();
  await page.mouse.move(box.x + 200, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + 300, box.y + 120, { steps: 3 });
  await page.mouse.up();
  assert.notEqual(turned, await picture());
}

// Nothing is drawn before it is asked for; then the picture follows the keys, which act in the view alone.
async function liveStarts(page) {
  assert.equal((await page.$$("#live canvas")).length, 0);
  await page.focus("#live button");
  await page.keyboard.press("Enter");
  await page.waitForSelector("#live canvas");
  const picture = async () => {
    await page.waitForTimeout(200);
    return page.$eval("#live canvas", (canvas) => {
      const copy = Object.assign(document.createElement("canvas"), { width: 100, height: 62 }),
        context = copy.getContext("2d");
      context.drawImage(canvas, 0, 0, 100, 62);
      return [...context.getImageData(0, 0, 100, 62).data].filter((_, i) => i % 4 === 1);
    });
  };
  const before = await picture();
  assert.ok(before.filter((level) => level > 100).length > 500, "the live view is dark");
  await page.keyboard.press("ArrowLeft");
  const turned = await picture();
  assert.notDeepEqual(before, turned);
  await page.evaluate(() => document.querySelector("#main").focus());
  await page.keyboard.press("ArrowLeft");
  assert.deepEqual(turned, await picture());
}

// By the keyboard: a condition in the table behind the map, then its page with the picture and the command.
async function cellOpens(page, data) {
  const index = data.atlas.cells.findIndex((cell) => cell.kind === "pictures"),
    cell = data.atlas.cells[index];
  await page.$$eval("#atlas details", (all) => all.forEach((e) => (e.open = true)));
  await page.focus(`#atlas td a[href="#cell-${index}"], #atlas th a[href="#cell-${index}"]`);
  await page.keyboard.press("Enter");
  await page.waitForSelector("#cell");
  assert.ok((await page.textContent("#cell")).includes(cell.command));
  assert.equal(await page.$eval("#cell img", (image) => image.complete && image.naturalWidth), 400);
  assert.equal(await page.evaluate(() => document.activeElement.id), "cell");
  execFileSync("sh", ["-c", cell.command.replace(/^laterna/, `'${laterna}'`)], { cwd: scratch, stdio: "ignore" });
}

// Every figure is there as a file of its own.
function figuresAreFiles() {
  const names = readdirSync(join(scratch, "figures")).sort();
  assert.deepEqual(names, [
    "atlas_laterna.svg",
    "atlas_opencv.svg",
    "board_rig.svg",
    "chart.svg",
    "difference_projector.svg",
    "frame_camera_projector.png",
    "left_out_poses.svg",
    "lens_ladder.svg",
    "map_projector_column_camera_projector.png",
    "map_projector_row_camera_projector.png",
    "map_standard_deviation_camera_projector.png",
    "range_projector.svg",
    "residual_histogram_camera_projector.svg",
    "residual_vectors_camera_projector.svg",
    "rig.svg",
    "uncertainty_by_range.svg",
    "uncertainty_projector.svg",
  ]);
  for (const name of names.filter((n) => n.endsWith(".svg")))
    assert.ok(!/nan|inf[^o]/.test(readFileSync(join(scratch, "figures", name), "utf8")), name);
}

async function prints(page) {
  await page.emulateMedia({ media: "print" });
  const seen = (selector) => page.$eval(selector, (e) => getComputedStyle(e).display !== "none");
  assert.deepEqual([await seen("nav"), await seen(".save"), await seen("main")], [false, false, true]);
  assert.equal(await page.evaluate(() => getComputedStyle(document.body).backgroundColor), "rgb(255, 255, 255)");
  if (screenshots) await page.pdf({ path: join(scratch, "print.pdf"), format: "A4" });
}

async function readable(page) {
  assert.equal(await page.$$eval("img", (all) => all.filter((e) => !e.alt).length), 0, "images without words");
  assert.equal(await page.$$eval("input", (all) => all.filter((e) => !e.labels.length).length), 0, "inputs without a label");
  assert.equal(await page.$$eval("main, nav, header", (all) => all.length), 3, "landmarks");
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "wider than the window");
}

async function darkIsDark(page) {
  await page.emulateMedia({ colorScheme: "dark" });
  const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  assert.ok(
    paper.match(/\d+/g).every((level) => Number(level) < 64),
    paper,
  );
}

async function wholePage(page, data) {
  await open(page, "page.html");
  const ids = await page.$$eval("main > section", (all) => all.map((e) => e.id));
  assert.deepEqual(ids, ["summary", "pictures", "rig", "residuals", "projection", "live", "board-rig", "board", "chart", "atlas"]);
  await numbersEqual(page, data);
  await figuresDraw(page, 11);
  await rigDraws(page, "#rig canvas.rig");
  await readable(page);
  await sliderMoves(page);
  await rigTurns(page);
  await cellOpens(page, data);
  await liveStarts(page);
  if (screenshots) await keep(page, "light.png");
  await darkIsDark(page);
  if (screenshots) await keep(page, "dark.png");
  await prints(page);
}

async function storedPage(page, data) {
  await page.emulateMedia({ media: "screen", colorScheme: "light" });
  await open(page, "stored.html");
  const ids = await page.$$eval("main > section", (all) => all.map((e) => e.id));
  assert.deepEqual(ids, ["summary", "selfcal", "plan", "plan-2", "chart", "chart-2", "atlas-reference-1"]);
  await numbersEqual(page, data);
  await figuresDraw(page, 7);
  await rigDraws(page, "#selfcal canvas.rig");
  await readable(page);
  await rigTurns(page);
  if (screenshots) await keep(page, "stored_light.png");
  await darkIsDark(page);
  if (screenshots) await keep(page, "stored_dark.png");
}

async function staticPage(page) {
  await open(page, "static.html");
  assert.ok((await page.$$("svg")).length >= 12);
  assert.ok((await page.textContent("p")).includes("static figures"));
  assert.equal((await page.$$("script")).length, 0);
  if (screenshots) await keep(page, "static.png");
}

const data = gather(laterna, source, scratch),
  stored = gatherStored(laterna, source, scratch);
const browser = await chromium.launch({ executablePath: chromiumPath, args: flags });
try {
  const { page, complaints } = await watched(browser);
  try {
    await wholePage(page, data);
    await staticPage(page);
    await storedPage(page, stored);
    assert.deepEqual(complaints, []);
  } catch (error) {
    await keep(page, "failed.png");
    throw error;
  }
  figuresAreFiles();
} finally {
  await browser.close();
}
