// A self-calibration: devices and stations from correspondences alone, and what they leave.
import * as P from "./plot.js";
import { h, figure, format, number, section, table } from "./dom.js";
import { blue, orange } from "./colours.js";
import { selfcalRig } from "./rig.js";

const stationName = (row) => `${row.device} ${row.station}`;

function residuals(stations) {
  const rows = stations.flatMap((s) => [
    { station: stationName(s), px: s.fit_rms_px, what: "residuals of the fit" },
    { station: stationName(s), px: s.predicted_px, what: "predicted error by noise" },
  ]);
  return P.plot({
    height: 70 + 28 * stations.length,
    marginLeft: 200,
    x: { label: "px rms", grid: true, zero: true },
    y: { label: null, domain: stations.map(stationName) },
    color: { domain: [rows[0].what, rows[1].what], range: [blue, orange] },
    symbol: { domain: [rows[0].what, rows[1].what], range: ["circle", "diamond"], legend: true },
    marks: [
      P.dot(
        rows.filter((row) => row.px !== null),
        { x: "px", y: "station", fill: "what", stroke: "what", symbol: "what", r: 5, title: (row) => `${row.what}: ${format(row.px)} px` },
      ),
    ],
  });
}

function deviceTable(data, k) {
  const value = (key) => (_, d) => number(data, ["selfcals", k, "devices", d, key]);
  const sigma = (key) => (row, d) =>
    key in row.sigma ? number(data, ["selfcals", k, "devices", d, "sigma", key]) : "held";
  const columns = ["fx", "fy", "cx", "cy"].flatMap((key) => [
    [`${key}, px`, value(key)],
    ["±", sigma(key)],
  ]);
  return table("Devices", [["device", (row) => row.name], ...columns], data.selfcals[k].devices);
}

function stationTable(data, k) {
  const value = (key) => (_, s) => number(data, ["selfcals", k, "stations", s, key]);
  return table(
    "Stations: one placement of one device each",
    [
      ["station", stationName],
      ["sightings", value("sightings")],
      ["fit, px rms", value("fit_rms_px")],
      ["predicted to, px", value("predicted_px")],
    ],
    data.selfcals[k].stations,
  );
}

function remarks(data, k) {
  const c = data.selfcals[k],
    words = [...c.merged];
  if (c.weakest) words.push(["Weakest: ", c.weakest.direction, ", standard deviation ", number(data, ["selfcals", k, "weakest", "sigma"])]);
  if (c.dropped.length > 0) words.push(`Dropped as outliers: ${c.dropped.length} sightings`);
  if (c.unit) words.push(c.unit === "metre" ? "Lengths are in metres" : "Lengths are known up to scale");
  return h(
    "ul",
    {},
    words.map((line) => h("li", {}, line)),
  );
}

/** The k-th of the self-calibrations. */
export function selfcal(data, k) {
  const { devices, stations } = data.selfcals[k];
  return section(
    k === 0 ? "selfcal" : `selfcal-${k + 1}`,
    `Self-calibration: ${data.selfcal_names[k]}`,
    stations.length === 0 && h("p", {}, "Nothing was calibrated: the verdict says why."),
    remarks(data, k),
    selfcalRig(data, k),
    devices.length > 0 && deviceTable(data, k),
    stations.length > 0 &&
      figure(`${data.selfcal_names[k]}: residuals by station, beside the error that noise predicts`, residuals(stations), stationTable(data, k)),
  );
}
