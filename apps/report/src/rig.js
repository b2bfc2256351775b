// The rig: a 3D view, and its devices as a table.
import { h, format, number, section, table } from "./dom.js";
import { blue, vermilion, orange } from "./colours.js";
import { centre, view3d } from "./rig3d.js";

function drawing(figures, devices) {
  try {
    return view3d(figures, devices);
  } catch {
    return h("p", { role: "status" }, "This browser has no WebGL, so the rig is told by the table alone.");
  }
}

// A rig of devices, with the path in the data of each kind; `of` says what the orange points are.
function rigSection(id, title, data, figures, paths, of, unit) {
  const devices = Object.keys(paths).flatMap((kind) =>
    figures.rig[kind].map((device, k) => ({ kind: kind.slice(0, -1), device, path: [...paths[kind], k] })),
  );
  const value =
    (...keys) =>
    (row) =>
      number(data, [...row.path, ...keys]);
  const key = [
    [vermilion, "projector"],
    [blue, "camera"],
    [orange, of],
  ].map(([colour, words]) => h("li", {}, h("span", { style: `background:${colour}` }), words));
  return section(
    id,
    title,
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
      h("ul", { class: "key" }, key),
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
  );
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
