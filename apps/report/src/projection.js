// Recovered against true over the projector's image, and what the estimate thinks of itself, by range.
import * as P from "./plot.js";
import { h, figure, format, number, section, table } from "./dom.js";
import { blue, orange } from "./colours.js";

const depthName = (depth) => `at ${format(depth)} m`;

function facets(p, size, fill, label, extra = []) {
  const [w, hgt] = size,
    width = P.plotWidth();
  const rows = p.grid.map((row) => ({ ...row, size: Math.hypot(row.du, row.dv), facet: depthName(row.depth_m) }));
  return P.plot({
    width,
    height: (width / 3) * (hgt / w) + 100,
    marginLeft: 50,
    marginTop: 32,
    fx: { label: null, domain: p.depths_m.map(depthName) },
    x: { label: "column, px", ticks: 3, domain: [-w / 32, w * (1 + 1 / 32)] },
    y: { label: "row, px", ticks: 4, domain: [hgt * (1 + 1 / 24), -hgt / 24] },
    color: { scheme: "viridis", legend: true, label, zero: true, marginLeft: 16, width: 280 },
    marks: [
      P.rect(rows, {
        fx: "facet",
        x1: (d) => d.u - w / 30,
        x2: (d) => d.u + w / 30,
        y1: (d) => d.v - hgt / 22,
        y2: (d) => d.v + hgt / 22,
        fill,
        title: (d) => `du ${d.du}, dv ${d.dv}, σ ${d.sigma_px} px`,
      }),
      ...extra.map((mark) => mark(rows)),
    ],
  });
}

const arrows = (rows) =>
  P.vector(rows, {
    fx: "facet",
    x: "u",
    y: "v",
    length: "size",
    rotate: (d) => (Math.atan2(d.dv, d.du) * 180) / Math.PI + 90,
    stroke: "white",
    strokeWidth: 1,
    anchor: "middle",
    tip: false,
  });

function byRange(p) {
  const [near, far] = p.lit_depths_m;
  return P.plot({
    height: 340,
    marginLeft: 70,
    x: { type: "log", label: "depth, m", grid: true },
    y: { type: "log", label: "px rms over the image", grid: true },
    color: { domain: ["error against the truth", "noise predicts"], range: [blue, orange], legend: true },
    marks: [
      P.rectX([{ near, far }], { x1: "near", x2: "far", fill: "currentColor", fillOpacity: 0.08 }),
      P.text([[Math.sqrt(near * far)]], { x: "0", frameAnchor: "top", text: () => "lit", dy: 4 }),
      P.line(p.by_range, {
        x: "depth_m",
        y: "predicted_rms_px",
        stroke: () => "noise predicts",
        strokeDasharray: "5 3",
        strokeWidth: 2,
      }),
      P.lineY(p.by_range, {
        x: "depth_m",
        y: "error_rms_px",
        stroke: () => "error against the truth",
        strokeWidth: 2,
        marker: "dot",
      }),
    ],
  });
}

function gridTable(data, path, p) {
  const value = (key) => (row, i) => number(data, [...path, "grid", i, key]);
  return table(
    "Grid over the projector's image",
    ["depth_m", "u", "v", "du", "dv", "sigma_px"].map((key) => [key, value(key)]),
    p.grid,
  );
}

export function projections(data) {
  return section(
    "projection",
    "Recovered against true, and how sure",
    data.figures.projections.map((p, k) => {
      if (!p) return h("p", {}, "No comparison: no lit point lies in front of the projector.");
      const path = ["figures", "projections", k],
        size = data.figures.rig.projectors.find((d) => d.name === p.projector).size;
      const range = (key) => (row, i) => number(data, [...path, "by_range", i, key]);
      return h(
        "div",
        {},
        h("h3", {}, `Projector “${p.projector}”`),
        figure(
          `Projection difference of “${p.projector}”: recovered minus true, px; strokes show the direction`,
          facets(p, size, "size", "difference, px", [arrows]),
          gridTable(data, path, p),
        ),
        figure(
          `Uncertainty of “${p.projector}” by range: standard deviation of a projected pixel from the estimate's own covariance, px`,
          facets(p, size, "sigma_px", "σ, px"),
        ),
        figure(
          `Error of “${p.projector}” by range, rms over the image, beside what noise alone predicts; shaded: the depths that were lit`,
          byRange(p),
          table(
            "By range",
            [
              ["depth, m", range("depth_m")],
              ["error, px rms", range("error_rms_px")],
              ["predicted, px rms", range("predicted_rms_px")],
            ],
            p.by_range,
          ),
        ),
      );
    }),
  );
}
