// Speed against accuracy, with the Pareto front and the bound.
import * as P from "./plot.js";
import { h, figure, number, section, table } from "./dom.js";
import { blue, vermilion, orange } from "./colours.js";

function pareto(chart) {
  const points = chart.points.filter((p) => p.seconds > 0 && p.error_px > 0);
  const front = points.filter((p) => chart.pareto.includes(p.label)).sort((a, b) => a.seconds - b.seconds);
  const low = (p) => Math.max(p.error_px - p.spread_px, p.error_px / 10);
  return P.plot({
    height: 440, marginLeft: 70, marginRight: 90, x: { type: "log", label: "seconds", grid: true }, y: { type: "log", label: "error, px rms", grid: true },
    color: { domain: ["on the Pareto front", "measured", "bound"], range: [vermilion, blue, orange], legend: true },
    marks: [
      P.line(front, { x: "seconds", y: "error_px", stroke: () => "on the Pareto front", curve: "step-after", strokeWidth: 2 }),
      P.dot(points.filter((p) => p.bound_px > 0), { x: "seconds", y: "bound_px", symbol: "times", stroke: () => "bound" }),
      P.ruleX(points.filter((p) => p.spread_px > 0), { x: "seconds", y1: low, y2: (p) => p.error_px + p.spread_px, stroke: blue, strokeOpacity: 0.6 }),
      P.dot(points, { x: "seconds", y: "error_px", r: 5, symbol: (p) => (chart.pareto.includes(p.label) ? "diamond" : "circle"),
        fill: (p) => (chart.pareto.includes(p.label) ? "on the Pareto front" : "measured"), title: (p) => `${p.label}\n${p.command}` }),
      P.text(points, { x: "seconds", y: "error_px", text: "label", dx: 8, dy: -8, textAnchor: "start" })],
  });
}

export function chart(data) {
  const value = (key) => (row) => number(data, ["chart", "points", data.chart.points.indexOf(row), key]);
  const rows = [...data.chart.points].sort((a, b) => a.seconds - b.seconds);
  return section("chart", "Speed against accuracy",
    figure("Error against seconds, both logarithmic; bars: spread over seeds; crosses: the bound that noise sets", pareto(data.chart)),
    table("Every point, and the command that measures it", [["label", (row) => row.label], ["seconds", value("seconds")], ["error, px", value("error_px")],
      ["spread, px", value("spread_px")], ["bound, px", value("bound_px")], ["Pareto", (row) => (data.chart.pareto.includes(row.label) ? "yes" : "no")],
      ["command", (row) => h("code", {}, row.command)]], rows));
}
