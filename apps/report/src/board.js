// A calibration from boards: the ladder of lenses, how sure pixels are by range, pose by pose.
import * as P from "./plot.js";
import { h, figure, number, section, table } from "./dom.js";
import { blue, vermilion, sky } from "./colours.js";

const rungName = (rung, k) => `${k + 1}. ${rung.lenses.join(" / ")}${rung.board_bend ? " + bend" : ""}`;

function ladder(board) {
  const rows = board.ladder.map((rung, k) => ({
    name: rungName(rung, k),
    rms: rung.held_out_px.rms,
    mean: rung.held_out_px.geometric_mean,
    scatter: rung.held_out_px.scatter,
    chosen: rung.chosen,
    fits: rung.fit_rms_px ?? [],
  }));
  return P.plot({
    height: 60 + 26 * rows.length,
    marginLeft: 260,
    x: { nice: true, label: "px rms; poses left out (dots), fit of each device (ticks)", grid: true },
    y: { label: null, domain: rows.map((row) => row.name) },
    color: { domain: ["climbed", "tried"], range: [vermilion, blue], legend: true },
    marks: [
      P.tickX(
        rows.flatMap((row) => row.fits.map((fit) => ({ name: row.name, fit }))),
        { x: "fit", y: "name", stroke: "currentColor", strokeOpacity: 0.5 },
      ),
      P.dot(rows, {
        x: "rms",
        y: "name",
        r: 6,
        symbol: (d) => (d.chosen ? "diamond" : "circle"),
        fill: (d) => (d.chosen ? "climbed" : "tried"),
        title: (d) => `${d.rms} px`,
      }),
    ],
  });
}

function ladderTable(data) {
  const value =
    (...keys) =>
    (row, k) =>
      number(data, ["board", "ladder", k, ...keys]);
  return table(
    "Lens ladder, px",
    [
      ["lenses", rungName],
      ["held out", value("held_out_px", "rms")],
      ["scatter", value("held_out_px", "scatter")],
      ["gain over its error", value("gain_over_error")],
      ["climbed", (rung) => (rung.chosen ? "yes" : "no")],
      ["moved", (rung) => rung.moved],
    ],
    data.board.ladder,
  );
}

function sigmaRows(board) {
  return ["cameras", "projectors"].flatMap((kind) =>
    board[kind].flatMap((device, d) =>
      device.prediction_sigma_px.map((row, r) => ({
        ...row,
        device: device.name,
        path: ["board", kind, d, "prediction_sigma_px", r],
      })),
    ),
  );
}

function byRange(rows) {
  return P.plot({
    height: 320,
    marginLeft: 60,
    x: { type: "log", label: "range, in the board's unit", grid: true },
    y: { label: "standard deviation, px", grid: true, zero: true },
    color: { legend: true, range: [blue, vermilion, sky], domain: [...new Set(rows.map((row) => row.device))] },
    marks: [
      P.lineY(rows, { x: "range", y: "rms", stroke: "device", marker: "dot", strokeWidth: 2 }),
      P.lineY(rows, { x: "range", y: "worst", stroke: "device", strokeDasharray: "3 4" }),
    ],
  });
}

function poses(board) {
  const rows = board.poses.map((pose, k) => ({ pose: String(pose.pose), rms: board.held_out_px?.folds[k] ?? null }));
  return P.plot({
    height: 260,
    marginLeft: 60,
    x: { label: "pose", domain: rows.map((row) => row.pose) },
    y: { label: "left out, px rms", grid: true },
    marks: [P.barY(rows, { x: "pose", y: "rms", fill: blue }), P.ruleY([0])],
  });
}

export function board(data) {
  const b = data.board,
    sigmas = sigmaRows(b);
  const at = (key) => (row) => number(data, [...row.path, key]);
  const pose = (key) => (row, k) => number(data, ["board", "poses", k, key]);
  return section(
    "board",
    "Calibration from boards",
    b.ladder.length === 0 && h("p", {}, "Nothing was calibrated: the verdict says why."),
    b.ladder.length > 0 && figure("Lens ladder: error of poses that were left out, by lens model", ladder(b), ladderTable(data)),
    sigmas.length > 0 &&
      figure(
        "Uncertainty by range: standard deviation of predicted pixels by noise alone; whole image (line), worst pixel (dashed)",
        byRange(sigmas),
        table(
          "Uncertainty by range, px",
          [
            ["device", (row) => row.device],
            ["range", at("range")],
            ["centre", at("center")],
            ["whole image", at("rms")],
            ["worst", at("worst")],
          ],
          sigmas,
        ),
      ),
    b.poses?.length > 0 &&
      b.held_out_px?.folds.length > 0 &&
      figure(
        "Each pose left out in turn: error of its projector pixels",
        poses(b),
        table(
          "Poses",
          [
            ["pose", (row) => String(row.pose)],
            ["left out, px rms", (row, k) => number(data, ["board", "held_out_px", "folds", k])],
            ["distance", pose("distance")],
            ["tilt, °", pose("tilt_deg")],
            ["leverage, px", pose("leverage_px")],
          ],
          b.poses,
        ),
      ),
    b.correlations?.length > 0 &&
      h(
        "div",
        {},
        h("h3", {}, "What trades off"),
        h(
          "ul",
          {},
          b.correlations.map((words) => h("li", {}, words)),
        ),
      ),
    b.warnings?.length > 0 &&
      h(
        "div",
        {},
        h("h3", {}, "Warnings"),
        h(
          "ul",
          {},
          b.warnings.map((words) => h("li", {}, words)),
        ),
      ),
  );
}
