// The page of one cell of the atlas: what happened, what broke, its picture, the command that does it again.
import { h, format, number } from "./dom.js";
import { outcomes, outcomeWords } from "./colours.js";

/** The worst of a cell: crashed or silently wrong if any seed was, else what most seeds were. */
export function outcomeOf(cell) {
  if (cell.crashed > 0) return "crashed";
  if (cell.silent > 0) return "silent";
  return ["right", "weak", "refused"].reduce((best, word) => (cell[word] > cell[best] ? word : best));
}

/** A cell's name without its grid's. */
export const condition = (cell) => cell.cell.replace(`${cell.grid}: `, "");

/** Where a cell's page is. */
export const link = (index) => `#cell-${index}`;

function facts(data, cell) {
  const value = (name) => number(data, ["atlas", "cells", cell.index, name]);
  const rows = [
    ...outcomes.map((word) => [outcomeWords[word], value(word), " seeds"]),
    ["median error", value("error_px"), " px rms over the volume"],
    ["median prediction", value("predicted_px"), " px rms, by the method or the bound"],
    ["seed by seed", h("code", {}, cell.letters), ""],
  ];
  return h(
    "dl",
    {},
    rows.map(([name, shown, unit]) => [h("dt", {}, name), h("dd", {}, shown, unit)]),
  );
}

function whatBroke(cell) {
  const items = cell.reasons.map(([text, n]) => `${text} (${n} of ${cell.letters.length} seeds; numbers left out)`);
  const times = cell.error_px / cell.predicted_px;
  if (cell.silent > 0 && times > 5)
    items.unshift(`no sign was given, but the median error is ${format(times)} times the prediction`);
  if (items.length === 0) items.push(cell.silent > 0 ? "no sign was given" : "nothing, and nothing was said");
  return [
    h("h4", {}, "What broke"),
    h(
      "ul",
      {},
      items.map((words) => h("li", {}, words)),
    ),
  ];
}

function picture(cell) {
  const alt = `What the camera of ${cell.cell} saw in white light, and beside it the columns that were decoded from it`;
  const caption =
    "Of the first seed that fared worst: what the camera saw in white light, and the columns that were decoded (grey: none).";
  return h("figure", {}, h("img", { src: cell.image, alt, width: 640 }), h("figcaption", {}, caption));
}

/** `cell` is one of data.atlas.cells with its `index`. */
export function cellPage(data, cell) {
  const next = link((cell.index + 1) % data.atlas.cells.length);
  return h("article", { id: "cell", tabindex: -1, "aria-label": "One cell of the atlas" }, [
    h("h3", {}, `${cell.method}: ${cell.grid}`),
    h("p", {}, h("strong", {}, outcomeWords[outcomeOf(cell)]), `, ${condition(cell)}`),
    facts(data, cell),
    cell.image && picture(cell),
    whatBroke(cell),
    h("h4", {}, "The same cell again"),
    h("p", {}, h("code", {}, cell.command)),
    h("p", {}, h("a", { href: "#atlas" }, "Back to the atlas"), " · ", h("a", { href: next }, "Next cell")),
  ]);
}
