// Where methods are right, say that they are weak, refuse, crash, or are silently wrong: a heat map per method, a page per cell.
import * as P from "./plot.js";
import { h, figure, number, section, table } from "./dom.js";
import { cellPage, condition, link, outcomeOf } from "./cell.js";
import { outcomes, outcomeColours, outcomeLetters, outcomeWords } from "./colours.js";

const methodsOf = (cells) => [...new Set(cells.map((cell) => cell.method))].sort((a, b) => (b === "laterna") - (a === "laterna")); // its own first

// Cells of a grid side by side, at most `across` in a row.
function laidOut(cells, across) {
  const rows = [];
  let line = 0;
  for (const grid of new Set(cells.map((c) => c.grid))) {
    const mine = cells.filter((c) => c.grid === grid);
    mine.forEach((cell, k) => rows.push({ cell, x: k % across, y: line + Math.floor(k / across), first: k === 0 }));
    line += Math.ceil(mine.length / across) + 0.4;
  }
  return { rows, lines: line };
}

function heatMap(cells) {
  const across = 40,
    size = Math.max(9, Math.floor((P.plotWidth() - 200) / across)),
    { rows, lines } = laidOut(cells, across);
  const svg = P.plot({
    width: 200 + across * size,
    height: 20 + lines * size,
    margin: 0,
    marginLeft: 200,
    marginTop: 10,
    marginBottom: 10,
    x: { axis: null, domain: [0, across] },
    y: { axis: null, domain: [lines, 0] },
    marks: [
      P.rect(rows, {
        x1: "x",
        x2: (d) => d.x + 1,
        y1: "y",
        y2: (d) => d.y + 1,
        inset: 0.75,
        fill: (d) => outcomeColours[outcomeOf(d.cell)],
        href: (d) => (d.cell.command ? link(d.cell.index) : null),
        title: (d) => `${condition(d.cell)}\n${outcomeWords[outcomeOf(d.cell)]}: ${d.cell.letters}`,
      }),
      P.text(rows, {
        x: (d) => d.x + 0.5,
        y: (d) => d.y + 0.5,
        text: (d) => outcomeLetters[outcomeOf(d.cell)],
        fill: (d) => (outcomeOf(d.cell) === "crashed" ? "white" : "black"),
        fontSize: Math.min(11, size * 0.7),
        pointerEvents: "none",
      }),
      P.text(
        rows.filter((d) => d.first),
        { x: () => 0, y: (d) => d.y + 0.5, text: (d) => d.cell.grid, textAnchor: "end", dx: -8 },
      ),
    ],
  });
  svg.querySelectorAll("a").forEach((a) => a.setAttribute("tabindex", "-1")); // the table behind holds the same links
  return svg;
}

function key() {
  return h(
    "ul",
    { class: "key" },
    outcomes.map((word) =>
      h("li", {}, h("span", { style: `background:${outcomeColours[word]}` }), `${outcomeLetters[word]}: ${outcomeWords[word]}`),
    ),
  );
}

// A stored reference has the outcomes, seed by seed, of Laterna's own method, and no page for a cell.
function referenceMap(cells, where) {
  const behind = table(
    `Cells${where}`,
    [
      ["condition", (cell) => cell.cell],
      ["outcome", (cell) => outcomeWords[outcomeOf(cell)]],
      ["seed by seed", (cell) => h("code", {}, cell.letters)],
    ],
    cells,
  );
  return figure(
    `Outcomes of method laterna${where}: one square per condition, by its worst seed where that is silent or crashed, else by most seeds`,
    heatMap(cells),
    behind,
  );
}

/** The k-th of the stored references of atlases. */
export function atlasReference(data, k) {
  const { name, summary, cells } = data.atlas_references[k],
    hidden = cells.filter((cell) => cell.hidden),
    count = (word) => (method) => number(data, ["atlas_references", k, "summary", "methods", method, word]);
  return section(
    `atlas-reference-${k + 1}`,
    `Atlas, as stored: ${name}`,
    table(
      "Problems by outcome",
      [["method", (method) => method], ...outcomes.map((word) => [outcomeWords[word], count(word)])],
      Object.keys(summary.methods),
    ),
    key(),
    referenceMap(
      cells.filter((cell) => !cell.hidden),
      ` in ${name}`,
    ),
    hidden.length > 0 && [
      h("h3", {}, "What no data can reveal"),
      h("p", {}, "Not counted: here a silently wrong answer is the only possible one."),
      referenceMap(hidden, ` in ${name} where no data can tell`),
    ],
  );
}

function methodMaps(data, cells, method, where = "") {
  const mine = cells.filter((cell) => cell.method === method);
  const behind = table(
    `Cells of ${method}${where}`,
    [
      ["condition", (cell) => h("a", { href: link(cell.index) }, cell.cell)],
      ["outcome", (cell) => outcomeWords[outcomeOf(cell)]],
      ["error, px", (cell) => number(data, ["atlas", "cells", cell.index, "error_px"])],
    ],
    mine,
  );
  return h(
    "div",
    {},
    h("h3", {}, `Method ${method}`),
    figure(
      `Outcomes of method ${method}${where}: one square per condition, by its worst seed where that is silent or crashed, else by most seeds`,
      heatMap(mine),
      behind,
    ),
  );
}

export function atlas(data) {
  const cells = data.atlas.cells.map((cell, index) => ({ ...cell, index }));
  const counted = cells.filter((cell) => !cell.hidden),
    hidden = cells.filter((cell) => cell.hidden);
  const names = Object.keys(data.atlas.summary.methods),
    stage = h("div", { "aria-live": "polite" });
  const open = () => {
    const found = location.hash.match(/^#cell-(\d+)$/),
      cell = found && cells[Number(found[1])];
    stage.replaceChildren(...(cell ? [cellPage(data, cell)] : []));
    if (cell) {
      stage.firstChild.scrollIntoView({ block: "center" });
      stage.firstChild.focus();
    }
  };
  window.addEventListener("hashchange", open);
  requestAnimationFrame(open);
  const count = (word) => (name) => number(data, ["atlas", "summary", "methods", name, word]);
  return section(
    "atlas",
    "Atlas: stability where methods fail",
    table(
      "Problems by outcome",
      [["method", (name) => name], ...outcomes.map((word) => [outcomeWords[word], count(word)])],
      names,
    ),
    key(),
    h(
      "p",
      {},
      "Choose a square, or a condition in the table behind it, for what happened there and the command that does it again.",
    ),
    stage,
    methodsOf(counted).map((method) => methodMaps(data, counted, method)),
    hidden.length > 0 &&
      h(
        "div",
        {},
        h("h3", {}, "What no data can reveal"),
        h("p", {}, "Not counted: here a silently wrong answer is the only possible one."),
        methodsOf(hidden).map((method) => methodMaps(data, hidden, method, " where no data can tell")),
      ),
  );
}
