// Elements, numbers that say where in the data they come from, and figures with their table behind them.

/** An element: h("p", {class: "x"}, "text", child). Listeners as onclick; null, false and empty children are left out. */
export function h(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== false && value != null) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child != null && child !== false && child !== ""));
  return element;
}

/** Four significant digits; whole numbers as they are. */
export function format(value) {
  if (value == null) return "–";
  if (Number.isInteger(value) && Math.abs(value) < 1e9) return String(value);
  const size = Math.abs(value);
  const short = Number(value.toPrecision(4));
  return size === 0 || (size >= 1e-5 && size < 1e6) ? String(short) : short.toExponential().replace("e+", "e");
}

/** The value at a path of keys, as at(data, ["verdicts", 0, "facts"]). */
export const at = (data, path) => path.reduce((inner, key) => inner?.[key], data);

/** A number of the data, shown: <data value="full" data-path="a.b">short</data>. */
export function number(data, path) {
  const value = at(data, path);
  if (typeof value !== "number") return h("span", {}, value == null ? "–" : String(value));
  return h("data", { value: String(value), "data-path": JSON.stringify(path), title: String(value) }, format(value));
}

/** A table; `columns` are [heading, row => cell, class or nothing]. The first column heads its row. */
export function table(caption, columns, rows) {
  const cell = (column, index, row, k) =>
    h(index === 0 ? "th" : "td", index === 0 ? { scope: "row" } : { class: column[2] }, column[1](row, k));
  return h(
    "div",
    { class: "scroll", tabindex: 0, role: "region", "aria-label": caption },
    h(
      "table",
      {},
      h("caption", {}, caption),
      h(
        "thead",
        {},
        h(
          "tr",
          {},
          columns.map(([name]) => h("th", { scope: "col" }, name)),
        ),
      ),
      h(
        "tbody",
        {},
        rows.map((row, k) =>
          h(
            "tr",
            {},
            columns.map((c, i) => cell(c, i, row, k)),
          ),
        ),
      ),
    ),
  );
}

/** A figure that screen readers meet as one image with a sentence, and its numbers in a table behind it. */
export function figure(caption, drawing, behind, more) {
  drawing.setAttribute("role", "img");
  drawing.setAttribute("aria-label", caption);
  return h(
    "figure",
    {},
    h("div", { class: "scroll" }, drawing),
    more,
    h("figcaption", {}, caption),
    behind && h("details", {}, h("summary", {}, "The numbers as a table"), behind),
    h("p", { class: "save" }, saveButton(drawing, caption)),
  );
}

// Saves the drawing's largest SVG, for papers.
function saveButton(drawing, caption) {
  const save = () => {
    const svg = drawing.matches("svg") ? drawing : [...drawing.querySelectorAll("svg")].at(-1);
    const copy = svg.cloneNode(true);
    copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    copy.setAttribute("color", "#000");
    const link = h("a", {
      href: URL.createObjectURL(new Blob([copy.outerHTML], { type: "image/svg+xml" })),
      download:
        caption
          .replace(/[^a-z0-9]+/gi, "-")
          .toLowerCase()
          .slice(0, 60) + ".svg",
    });
    link.click();
  };
  return h("button", { type: "button", onclick: save }, "Save as SVG");
}

export function section(id, title, ...children) {
  return h("section", { id, "aria-labelledby": id + "-title" }, h("h2", { id: id + "-title" }, title), ...children);
}
