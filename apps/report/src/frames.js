// The captured frames, with a slider through the patterns, and what was decoded from them.
import { h, number, section } from "./dom.js";

let count = 0;

function leafThrough(view, of) {
  const id = `frame-${count++}`;
  const image = h("img", { alt: "", width: 576, class: "frame" });
  const label = h("output", { for: id });
  const show = () => {
    const frame = view.frames[slider.valueAsNumber];
    image.src = frame.image;
    image.alt = `Frame as captured, ${of}: ${frame.label}`;
    label.textContent = `${slider.valueAsNumber + 1} of ${view.frames.length}: ${frame.label}`;
    slider.setAttribute("aria-valuetext", label.textContent);
  };
  const slider = h("input", { type: "range", id, min: 0, max: view.frames.length - 1, step: 1, oninput: show });
  slider.value = Math.max(
    0,
    view.frames.findIndex((frame) => frame.label === "white"),
  );
  const step = (by) => () => {
    slider.valueAsNumber += by;
    show();
  };
  show();
  return h(
    "figure",
    { class: "leaf" },
    image,
    h(
      "div",
      { class: "slider" },
      h("label", { for: id }, "Pattern"),
      h("button", { type: "button", "aria-label": "Previous pattern", onclick: step(-1) }, "‹"),
      slider,
      h("button", { type: "button", "aria-label": "Next pattern", onclick: step(1) }, "›"),
      label,
    ),
    h("figcaption", {}, `Frames as captured, shrunk: ${of}`),
  );
}

function mapFigure(data, map, path, of) {
  const value = (key) => number(data, [...path, key]);
  return h(
    "figure",
    { class: "map" },
    h("img", { src: map.image, alt: `Map of ${map.label}, ${of}, ${map.low} to ${map.high} ${map.unit}`, width: 400 }),
    h(
      "div",
      { class: "legend" },
      value("low"),
      h("span", { class: "viridis", "aria-hidden": "true" }),
      value("high"),
      " " + map.unit,
    ),
    h("figcaption", {}, map.label),
  );
}

export function frames(data) {
  return section(
    "pictures",
    "Pictures and decoded maps",
    data.views.map((view, k) => {
      const of = `“${view.projector}” seen by “${view.camera}”`;
      return h(
        "div",
        {},
        h("h3", {}, of),
        view.frames.length
          ? leafThrough(view, of)
          : h("p", {}, "No pictures were taken: the true projector pixels stood in for decoding."),
        view.valid_percent != null &&
          h(
            "p",
            {},
            "Decoded: ",
            number(data, ["views", k, "valid_percent"]),
            " % of the camera's pixels. Grey: no projector pixel.",
          ),
        h(
          "div",
          { class: "maps" },
          view.maps.map((map, m) => mapFigure(data, map, ["views", k, "maps", m], of)),
        ),
      );
    }),
  );
}
