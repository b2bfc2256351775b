// A folder with everything that a page can hold, as the commands leave it.
import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { cpSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

// A 7×6 board in six places before an ideal camera and projector, with a little deterministic noise.
function boardTable() {
  const lines = ["pose,corner,board_x,board_y,board_z,cam_x,cam_y,proj_x,proj_y,valid"];
  const tilts = "0 0, 0.5 0, -0.4 0.2, 0 0.5, 0.1 -0.5, 0.4 0.4".split(",").map((pair) => pair.trim().split(" ").map(Number));
  let noise = 1;
  const jitter = () => ((noise = (noise * 16807) % 2147483647) / 2147483647 - 0.5) * 0.2;
  tilts.forEach(([a, b], pose) => {
    for (let corner = 0; corner < 42; ++corner) {
      const x = (corner % 7) * 0.03 - 0.09;
      const y = Math.floor(corner / 7) * 0.03 - 0.075;
      const z = 0.8 + 0.07 * pose - x * Math.sin(b) + y * Math.sin(a) * Math.cos(b);
      const X = x * Math.cos(b) + y * Math.sin(a) * Math.sin(b) + 0.02 * (pose - 2);
      const Y = y * Math.cos(a);
      const pixel = (f, cx, cy, offset) => `${(f * (X + offset)) / z + cx + jitter()},${(f * Y) / z + cy + jitter()}`;
      lines.push(`${pose},${corner},${x + 0.09},${y + 0.075},0,${pixel(1400, 640, 512, 0)},${pixel(1500, 512, 700, 0.12)},1`);
    }
  });
  return lines.join("\n") + "\n";
}

// Points in a box before a camera and a projector that lights them, in a table for self-calibration.
function pairTable() {
  const lines = ["point,device,station,x,y"];
  let noise = 7;
  const uniform = () => (noise = (noise * 16807) % 2147483647) / 2147483647 - 0.5;
  for (let point = 0; point < 60; ++point) {
    const [x, y, z] = [1.2 * uniform(), 0.9 * uniform(), 2 + uniform()];
    const a = 0.25, [X, Z] = [x * Math.cos(a) - z * Math.sin(a) + 0.6, x * Math.sin(a) + z * Math.cos(a)];
    const jitter = () => 0.1 * uniform();
    lines.push(`p${point},camera,one,${(1500 * x) / z + 640 + jitter()},${(1500 * y) / z + 512 + jitter()}`);
    lines.push(`p${point},projector,one,${(1300 * X) / Z + 512 + jitter()},${(1300 * y) / Z + 384 + jitter()}`);
  }
  return lines.join("\n") + "\n";
}

const sweep = `
[[grid]]
name = "slab"
kind = "points"
seeds = 3
repeats = 1
methods = ["laterna", "dlt"]
points = [20, 100, 500]
`;

const conditions = (scene) => `
[[grid]]
name = "few"
kind = "points"
seeds = 3
methods = ["laterna", "opencv"]
points = [5, 30, 100]
[[grid]]
name = "seen"
kind = "pictures"
seeds = 1
scene = "${scene}"
[[grid]]
name = "shifted"
kind = "points"
hidden = true
seeds = 2
shift_u_px = [1, 2, 3]
`;

/** Runs the commands in `scratch`: a page, a static page, figures; gives the page's data, which are those of the files. */
export function gather(laterna, source, scratch) {
  const run = (...words) => {
    try {
      return execFileSync(laterna, words, {
        cwd: scratch,
        encoding: "utf8",
        stdio: ["ignore", "pipe", "ignore"],
        maxBuffer: 1 << 28,
      });
    } catch (error) {
      if (error.status === 3 || error.status === 4) return error.stdout; // refused or weak is an answer too
      throw error;
    }
  };
  const scene = join(source, "data/atlas/small.toml");
  const copy = (from, name) => cpSync(join(scratch, from, name), join(scratch, "all", name), { recursive: true });
  writeFileSync(join(scratch, "sweep.toml"), sweep);
  writeFileSync(join(scratch, "conditions.toml"), conditions(scene));
  writeFileSync(join(scratch, "board.csv"), boardTable());
  run("roundtrip", scene, "-o", "all");
  run("chart", "sweep.toml", "-o", "chart");
  run("atlas", "conditions.toml", "-o", "atlas");
  copy("chart", "chart.json");
  for (const name of ["atlas.json", "cells.json", "pictures"]) copy("atlas", name);
  run("calibrate", "board.csv", "--camera-size", "1280x1024", "--projector-size", "1024x768", "-o", "all/board.json");
  run("report", "all", "-o", "page.html");
  run("report", "all", "-o", "static.html", "--static", "--figures", "figures");
  const page = readFileSync(join(scratch, "page.html"), "utf8");
  const data = JSON.parse(page.match(/<script type="application\/json" id="data">(.*?)<\/script>/s)[1]);
  const json = (name) => JSON.parse(readFileSync(join(scratch, "all", name + ".json")));
  assert.deepEqual([data.result, data.board, data.charts[0], data.atlas.summary], ["result", "board", "chart", "atlas"].map(json));
  return data;
}

/** A folder of stored references and a self-calibration, and its page; gives the page's data, which are those of the files. */
export function gatherStored(laterna, source, scratch) {
  const folder = join(scratch, "stored");
  mkdirSync(folder);
  const named = { "plan/near_focus": "near_focus", "plan/v_groove": "v_groove", "charts/points": "points" };
  Object.assign(named, { "charts/second_sample": "second_sample", "atlas/standard": "standard" });
  for (const [from, to] of Object.entries(named)) cpSync(join(source, "data", from + ".json"), join(folder, to + ".json"));
  writeFileSync(join(scratch, "pair.csv"), pairTable());
  const words = ["--size", "camera=1280x1024", "--size", "projector=1024x768", "--known", "camera=1500,1500,640,512"];
  const options = { cwd: scratch, stdio: ["ignore", "ignore", "ignore"] };
  spawnSync(laterna, ["selfcal", "pair.csv", ...words, "--assume", "projector=focal", "-o", "stored/pair.json"], options);
  execFileSync(laterna, ["report", "stored", "-o", "stored.html"], options);
  execFileSync(laterna, ["report", "stored", "-o", "stored_static.html", "--static", "--figures", "stored_figures"], options);
  const page = readFileSync(join(scratch, "stored.html"), "utf8");
  const data = JSON.parse(page.match(/<script type="application\/json" id="data">(.*?)<\/script>/s)[1]);
  const json = (name) => JSON.parse(readFileSync(join(folder, name + ".json")));
  assert.deepEqual(data.plans, ["near_focus", "v_groove"].map(json));
  assert.deepEqual(data.charts, ["points", "second_sample"].map(json));
  assert.deepEqual(data.selfcals, [json("pair")]);
  assert.equal(data.selfcals[0].points.length, 60); // as many as the table has
  const rig = readFileSync(join(scratch, "stored_figures", "selfcal_rig_pair.svg"), "utf8");
  assert.ok(rig.includes("projector one") && !/nan|inf[^o]/.test(rig));
  const { letters, ...summary } = json("standard");
  assert.deepEqual(data.atlas_references[0].summary, summary);
  assert.deepEqual(Object.fromEntries(data.atlas_references[0].cells.map((cell) => [cell.cell, cell.letters])), letters);
  return data;
}
