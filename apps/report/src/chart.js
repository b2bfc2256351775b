// Speed against accuracy, with the front that nothing beats and the bound.
import * as P from "./plot.js";
import { h, figure, format, number, section, table } from "./dom.js";
import { seriesColours } from "./colours.js";

const shapes = ["circle", "square", "diamond", "triangle", "triangle2"];
const xLabels = { seconds: "seconds", capture_seconds: "seconds of capture" };

// Stored references hold what holds on every machine: seconds over those of the fastest point, and no commands.
const isReference = (chart) => chart.points.some((p) => "seconds_ratio" in p);
const xOf = (chart, p) =>
  chart.against === "seconds" ? (p.seconds ?? p.seconds_ratio) : (p.x ?? p[chart.against] ?? p.values[chart.against]);
const xLabel = (chart) =>
  chart.against === "seconds" && isReference(chart)
    ? "seconds, over those of the fastest point"
    : (xLabels[chart.against] ?? chart.against);

// The keys whose values differ within a series: what it sweeps.
function sweptKeys(points) {
  return Object.keys(points[0].values).filter((key) =>
    points.some((p) => JSON.stringify(p.values[key]) !== JSON.stringify(points[0].values[key])),
  );
}

// What can be drawn, with what each point's word is and whether its series is one line.
function drawable(chart) {
  return [...new Set(chart.points.map((p) => p.series))].flatMap((series) => {
    const points = chart.points.filter((p) => p.series === series).map((p) => ({ ...p, x: xOf(chart, p) })),
      keys = sweptKeys(points),
      rest = keys.filter((key) => key !== chart.against);
    const shown = points.filter((p) => p.x > 0 && p.error_px > 0);
    return shown.map((p) => ({
      ...p,
      front: chart.pareto.includes(p.label),
      joined: keys.length < 2 && shown.length > 1,
      word: rest.map((key) => `${key.split(".").at(-1)} ${p.values[key]}`).join(", "),
    }));
  });
}

function pareto(chart, points) {
  const names = [...new Set(chart.points.map((p) => p.series))],
    joined = points.filter((p) => p.joined),
    bounded = points.filter((p) => p.bound_px > 0);
  const front = points.filter((p) => p.front).sort((a, b) => a.x - b.x),
    xs = points.map((p) => p.x);
  const dash = Math.max(1.01, (Math.max(...xs) / Math.min(...xs)) ** 0.012); // half of a lone bound's length
  const hint = (p) => `${p.label}\n${format(p.error_px)} px, bound ${format(p.bound_px)} px, ${format(p.x)} ${xLabel(chart)}`;
  return P.plot({
    height: 480,
    marginLeft: 70,
    marginRight: 90,
    x: { type: "log", label: xLabel(chart), grid: true },
    y: { type: "log", label: "error over the volume, px rms", grid: true },
    color: { domain: names, range: seriesColours },
    symbol: { domain: names, range: shapes, legend: true },
    marks: [
      P.line(front, { x: "x", y: "error_px", curve: "step-after", stroke: "currentColor", strokeOpacity: 0.25, strokeWidth: 7 }),
      P.line(joined, { x: "x", y: "error_px", z: "series", stroke: "series", strokeWidth: 1.5, sort: "x" }),
      P.line(
        joined.filter((p) => p.bound_px > 0),
        { x: "x", y: "bound_px", z: "series", stroke: "series", strokeWidth: 1.5, strokeDasharray: "5 4", sort: "x" },
      ),
      P.link(
        bounded.filter((p) => !p.joined),
        {
          x1: (p) => p.x / dash,
          x2: (p) => p.x * dash,
          y: "bound_px",
          stroke: "series",
          strokeWidth: 1.5,
          strokeDasharray: "5 4",
        },
      ),
      P.ruleX(
        points.filter((p) => p.error_low_px > 0 && p.error_high_px > 0),
        { x: "x", y1: "error_low_px", y2: "error_high_px", stroke: "series" },
      ),
      chart.against === "seconds"
        ? P.ruleY(
            points.filter((p) => p.seconds_low > 0),
            { y: "error_px", x1: "seconds_low", x2: "seconds_high", stroke: "series" },
          )
        : null,
      P.dot(front, { x: "x", y: "error_px", r: 10, stroke: "currentColor", strokeWidth: 1.5, strokeOpacity: 0.7 }),
      P.dot(points, { x: "x", y: "error_px", r: 5, fill: "series", stroke: "series", symbol: "series", title: hint, tip: true }),
      P.text(
        points.filter((p) => points.length <= 16 || p.front),
        {
          x: "x",
          y: "error_px",
          text: "word",
          dx: 11,
          dy: -9,
          textAnchor: "start",
          fontSize: 11,
          stroke: "var(--paper)",
          fill: "currentColor",
          strokeWidth: 3,
        },
      ),
    ],
  });
}

/** The k-th of the charts. */
export function chart(data, k) {
  const c = data.charts[k],
    points = drawable(c),
    missing = c.points.length - points.length,
    stored = isReference(c),
    seconds = stored ? "seconds_ratio" : "seconds";
  const value = (key) => (row) => number(data, ["charts", k, "points", c.points.indexOf(row), key]);
  const rows = [...c.points].sort((a, b) => a[seconds] - b[seconds]);
  const quartiles = [
    ["lower quartile, px", value("error_low_px")],
    ["upper quartile, px", value("error_high_px")],
  ];
  const said = [
    ["said", (row) => row.reason ?? "", "said"],
    ["command", (row) => h("code", {}, row.command)],
  ];
  return section(
    k === 0 ? "chart" : `chart-${k + 1}`,
    `Speed against accuracy: ${c.chart}`,
    points.length > 0 &&
      figure(
        `${c.chart}: error, both axes logarithmic; bars: quartiles over the seeds; dashed: the bound that noise sets; broad grey and rings: the front, where nothing has less of both`,
        pareto(c, points),
      ),
    missing > 0 && h("p", {}, `${missing} of ${c.points.length} points gave no error to draw.`),
    table(
      stored ? "Every point, as stored" : "Every point, and the command that measures it",
      [
        ["label", (row) => row.label],
        [stored ? "seconds over the fastest" : "seconds", value(seconds)],
        ["error, px", value("error_px")],
        ...(stored ? quartiles : [["spread, px", value("spread_px")]]),
        ["bound, px", value("bound_px")],
        ["front", (row) => (c.pareto.includes(row.label) ? "yes" : "no")],
        ["refused", value("refused")],
        ["crashed", value("crashed")],
        ...(stored ? [] : said),
      ],
      rows,
    ),
  );
}
