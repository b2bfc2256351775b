// The rig: a 3D view, and its devices as a table.
import { h, format, number, section, table } from "./dom.js";
import { blue, vermilion, orange, deviceColours } from "./colours.js";
import { centre, view3d } from "./rig3d.js";

function drawing(figures, devices) {
  try {
    return view3d(figures, devices);
  } catch {
    return h("p", { role: "status" }, "This browser has no WebGL, so the rig is told by the table alone.");
  }
}

// A rig to turn, and its devices as a table: {kind, device, path in the data}; `key` lists [colour, words].
function rigFigure(data, figures, devices, key, unit) {
  const value =
    (...keys) =>
    (row) =>
      number(data, [...row.path, ...keys]);
  const swatch = ([colour, words]) => h("li", {}, h("span", { style: `background:${colour}` }), words);
  return [
    h(
      "figure",
      {},
      h(
        "div",
        {},
        drawing(
          figures,
          devices.map((d) => d.device),
        ),
      ),
      h("ul", { class: "key" }, key.map(swatch)),
      h(
        "figcaption",
        {},
        "Drag to turn, wheel to zoom; with the keyboard: arrows, + and −. Frusta without lens distortion; large meshes are thinned.",
      ),
    ),
    table(
      `Devices: pixels, and where they stand, in ${unit}`,
      [
        ["device", (row) => `${row.kind} “${row.device.name}”`],
        ["width", value("size", 0)],
        ["height", value("size", 1)],
        ["fx", value("fx")],
        ["fy", value("fy")],
        ["cx", value("cx")],
        ["cy", value("cy")],
        [
          "centre",
          (row) =>
            centre(row.device)
              .map((x) => format(Number(x.toPrecision(4))))
              .join(", "),
        ],
      ],
      devices,
    ),
  ];
}

// Of projectors and cameras, with the path in the data of each kind; `of` says what the orange points are.
function rigSection(id, title, data, figures, paths, of, unit) {
  const devices = Object.keys(paths).flatMap((kind) =>
    figures.rig[kind].map((device, k) => ({ kind: kind.slice(0, -1), device, path: [...paths[kind], k] })),
  );
  const key = [
    [vermilion, "projector"],
    [blue, "camera"],
    [orange, of],
  ];
  return section(id, title, rigFigure(data, figures, devices, key, unit));
}

export function rig(data) {
  const path = ["figures", "rig"];
  return rigSection(
    "rig",
    "The rig",
    data,
    data.figures,
    { projectors: [...path, "projectors"], cameras: [...path, "cameras"] },
    "lit points",
    "metres of the world frame",
  );
}

/** Of a calibration from boards: in the camera's frame, with the middle of each board's distance on its axis. */
export function boardRig(data) {
  const { cameras, projectors, poses } = data.board,
    still = [
      [1, 0, 0, 0],
      [0, 1, 0, 0],
      [0, 0, 1, 0],
    ];
  const stand = (devices, key) => devices.map((d) => ({ ...d, device_from_world: d[key] ?? still }));
  const figures = {
    rig: { projectors: stand(projectors, "device_from_camera"), cameras: stand(cameras, "device_from_world"), meshes: [] },
    points: poses.flatMap((pose) => [0, 0, pose.distance]),
  };
  return rigSection(
    "board-rig",
    "The rig from boards",
    data,
    figures,
    { projectors: ["board", "projectors"], cameras: ["board", "cameras"] },
    "distances of the boards",
    "the board's unit, in the camera's frame",
  );
}

/** Of the k-th self-calibration: every station of every device, and the points; nothing where it has no points. */
export function selfcalRig(data, k) {
  const { devices, stations, points, unit } = data.selfcals[k];
  if (!points?.length) return null;
  const colour = (d) => deviceColours[d % deviceColours.length];
  const placed = stations.map((s) => {
    const d = devices.findIndex((device) => device.name === s.device);
    const device = { ...devices[d], name: s.station, device_from_world: s.device_from_first, colour: colour(d) };
    return { kind: s.device, device, path: ["selfcals", k, "devices", d] };
  });
  const figures = { rig: { projectors: [], cameras: placed.map((p) => p.device), meshes: [] }, points: points.flat() };
  const key = [...devices.map((d, i) => [colour(i), d.name]), [orange, "points that are seen"]];
  return rigFigure(data, figures, placed, key, `${unit === "metre" ? "metres" : "unit baselines"}, in the first station's frame`);
}
