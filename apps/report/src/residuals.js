// What the solve leaves over: decoded minus projected, with direction as colour, and how large it should be.
import * as P from "./plot.js";
import { h, figure, number, section, table } from "./dom.js";
import { directionColour, sky, vermilion } from "./colours.js";

function vectors(r, size) {
  const rms = r.rms_px || 1;
  const rows = r.sample.map(([u, v, du, dv]) => ({ u, v, du, dv, size: Math.hypot(du, dv), angle: Math.atan2(dv, du) }));
  const aspect = size ? size[1] / size[0] : 0.6;
  return P.plot({
    height: P.plotWidth() * Math.min(1, aspect) + 50,
    marginLeft: 60,
    marginTop: 30,
    x: { label: "projector column, px", domain: size && [-0.5, size[0] - 0.5] },
    y: { label: "projector row, px", reverse: true, domain: size && [size[1] - 0.5, -0.5], ...(size && { reverse: false }) },
    length: { range: [0, 14], domain: [0, rms] },
    marks: [
      P.frame({ strokeOpacity: 0.3 }),
      P.vector(rows, {
        x: "u",
        y: "v",
        length: "size",
        rotate: (d) => (d.angle * 180) / Math.PI + 90,
        stroke: (d) => directionColour(d.angle),
        strokeWidth: 1.4,
        anchor: "start",
        title: (d) => `du ${d.du}, dv ${d.dv} px`,
      }),
    ],
  });
}

/** A wheel that says which colour is which direction; v points down. */
function wheel() {
  const steps = Array.from({ length: 36 }, (_, k) => k * 10);
  const svg = P.plot({
    width: 130,
    height: 130,
    margin: 14,
    marginBottom: 14,
    x: { domain: [-1.3, 1.3], axis: null },
    y: { domain: [1.3, -1.3], axis: null },
    marks: [
      P.vector(steps, {
        x: (a) => 0.3 * Math.cos((a * Math.PI) / 180),
        y: (a) => 0.3 * Math.sin((a * Math.PI) / 180),
        length: 26,
        anchor: "start",
        rotate: (a) => a + 90,
        stroke: (a) => directionColour((a * Math.PI) / 180),
        strokeWidth: 3,
      }),
      P.text(
        [
          [1.25, 0, "+u"],
          [0, 1.25, "+v"],
        ],
        { x: "0", y: "1", text: "2" },
      ),
    ],
  });
  svg.setAttribute("role", "img");
  svg.setAttribute("aria-label", "Which colour stands for which direction: u to the right, v down");
  return h("div", { class: "wheel" }, svg);
}

function bins(r) {
  const { edges_px: edges, count, predicted } = r.histogram;
  return count.map((n, k) => ({ from: edges[k], to: edges[k + 1], n, predicted: predicted[k] }));
}

function histogram(r) {
  const rows = bins(r);
  return P.plot({
    height: 300,
    marginLeft: 60,
    x: { label: "du and dv, px" },
    y: { label: "count", grid: true },
    marks: [
      P.rectY(rows, { x1: "from", x2: "to", y: "n", fill: sky, insetLeft: 0.5, insetRight: 0.5 }),
      P.line(rows, { x: (d) => (d.from + d.to) / 2, y: "predicted", stroke: vermilion, strokeWidth: 2.5 }),
      P.ruleY([0]),
    ],
  });
}

export function residuals(data) {
  return section(
    "residuals",
    "Residuals",
    data.figures.residuals.map((r, k) => {
      if (!r) return h("p", {}, "No residuals: nothing was decoded on a surface.");
      const value = (key) => number(data, ["figures", "residuals", k, key]);
      const of = `“${r.projector}” seen by “${r.camera}”`;
      const size = data.figures.rig.projectors.find((p) => p.name === r.projector)?.size;
      return h(
        "div",
        {},
        h("h3", {}, of),
        h(
          "p",
          {},
          value("rms_px"),
          " px rms over ",
          value("used"),
          " of ",
          value("points"),
          " points; stated standard deviation ",
          value("sigma_px"),
          " px per coordinate.",
        ),
        figure(
          `Residual vectors of ${of}: where they point is their colour; a stroke of full length is the rms or more`,
          vectors(r, size),
          table(
            "Residuals, px",
            ["u", "v", "du", "dv"].map((name, i) => [name, (row) => String(row[i])]),
            r.sample.slice(0, 100),
          ),
          wheel(),
        ),
        figure(
          `Residuals of ${of} counted (bars) against what the stated standard deviations predict (line)`,
          histogram(r),
          table(
            "Histogram",
            [
              ["from, px", (row) => row.from.toPrecision(3)],
              ["to, px", (row) => row.to.toPrecision(3)],
              ["count", (row, i) => number(data, ["figures", "residuals", k, "histogram", "count", i])],
              ["predicted", (row, i) => number(data, ["figures", "residuals", k, "histogram", "predicted", i])],
            ],
            bins(r),
          ),
        ),
      );
    }),
  );
}
