// No more than the scene needs: what was kept and dropped, and what each would have changed and cost.
import * as P from "./plot.js";
import { h, figure, format, number, section, table } from "./dom.js";
import { blue, grey, orange, vermilion } from "./colours.js";

const verdicts = { small: blue, unsure: orange, large: vermilion, refused: grey };

// Every level that was tried, with where in the data it is.
const triedRows = (plan, k) =>
  plan.choices.flatMap((choice, c) =>
    choice.tried.map((tried, t) => ({
      ...tried,
      choice,
      name: `${choice.name}: ${tried.value}`,
      path: ["plans", k, "choices", c, "tried", t],
      last: t === choice.tried.length - 1,
    })),
  );

function changes(plan, rows) {
  const least = plan.tolerance_px / 1000,
    shown = rows.filter((row) => row.change_px !== null),
    used = Object.keys(verdicts).filter((word) => shown.some((row) => row.verdict === word));
  const place = (value) => Math.max(value, least);
  return P.plot({
    height: 80 + 26 * rows.length,
    marginLeft: 240,
    x: { type: "log", label: "change of the answer, px rms", grid: true },
    y: { label: null, domain: rows.map((row) => row.name) },
    color: { domain: used, range: used.map((word) => verdicts[word]), legend: true },
    marks: [
      P.ruleX([plan.tolerance_px], { stroke: "currentColor", strokeWidth: 2, strokeDasharray: "5 4" }),
      P.ruleY(shown, {
        y: "name",
        x1: (row) => place(row.change_px - row.doubt_px),
        x2: (row) => place(row.change_px + row.doubt_px),
        stroke: "verdict",
      }),
      P.dot(shown, {
        x: (row) => place(row.change_px),
        y: "name",
        r: 5,
        fill: "verdict",
        title: (row) => `${row.name}\n${format(row.change_px)} px ± ${format(row.doubt_px)} px`,
      }),
    ],
  });
}

function triedTable(data, plan, rows) {
  const at = (key) => (row) => number(data, [...row.path, key]);
  const saves = rows.some((row) => "seconds_saved" in row) ? [["saves, s", at("seconds_saved")]] : [];
  return table(
    "Each alone, at low cost",
    [
      ["choice", (row) => row.choice.name],
      ["tried", (row) => `${row.choice.full} → ${row.value}`],
      ["changes, px", at("change_px")],
      ["±", at("doubt_px")],
      ...saves,
      ["alone", (row) => row.verdict],
      ["in the plan", (row) => (row.last ? row.choice.end : "")],
      ["said", (row) => row.reason, "said"],
    ],
    rows,
  );
}

const list = (names) => (names.length > 0 ? names.join(", ") : "nothing");

/** The k-th of the plans. */
export function plan(data, k) {
  const p = data.plans[k],
    rows = triedRows(p, k);
  const cheaper = p.choices.filter((choice) => choice.end === "cheaper").map((c) => `${c.name} ${c.full} → ${c.plan}`);
  return section(
    k === 0 ? "plan" : `plan-${k + 1}`,
    `No more than the scene needs: ${data.plan_names[k]}`,
    h("p", {}, `Kept: ${list(p.kept)}. Dropped: ${list(p.dropped)}. Cheaper: ${list(cheaper)}.`),
    p.scene && h("p", {}, "The reduced scene: ", h("code", {}, p.scene)),
    rows.length > 0 &&
      figure(
        `${data.plan_names[k]}: what each changes alone, at low cost, with its doubt; dashed: the tolerance; below a thousandth of it, drawn there`,
        changes(p, rows),
      ),
    triedTable(data, p, rows),
  );
}
