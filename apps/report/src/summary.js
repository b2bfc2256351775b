// The verdicts: first what to believe, then why.
import { h, number, section } from "./dom.js";

const signs = { ok: "✓", weak: "!", refused: "✕", failed: "✕" };

export function summary(data) {
  return section(
    "summary",
    "Verdict",
    h(
      "div",
      { class: "cards" },
      data.verdicts.map((verdict, k) =>
        h(
          "article",
          { class: "card " + (verdict.status || "none") },
          h(
            "h3",
            {},
            verdict.of,
            " ",
            verdict.status &&
              h("strong", { class: "badge" }, h("span", { "aria-hidden": "true" }, signs[verdict.status]), " " + verdict.status),
          ),
          verdict.reason && h("p", {}, verdict.reason),
          h(
            "dl",
            {},
            verdict.facts.map((fact, i) => [
              h("dt", {}, fact.name),
              h("dd", {}, number(data, ["verdicts", k, "facts", i, "value"]), fact.unit ? " " + fact.unit : ""),
            ]),
          ),
        ),
      ),
    ),
  );
}
