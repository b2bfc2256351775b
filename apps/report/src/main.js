// The page: a section for each thing that the data hold.
import { h } from "./dom.js";
import { summary } from "./summary.js";
import { frames } from "./frames.js";
import { boardRig, rig } from "./rig.js";
import { residuals } from "./residuals.js";
import { projections } from "./projection.js";
import { board } from "./board.js";
import { chart } from "./chart.js";
import { plan } from "./plan.js";
import { selfcal } from "./selfcal.js";
import { atlas, atlasReference } from "./atlas.js";
import { live } from "./live.js";
import css from "./page.css";

const data = JSON.parse(document.getElementById("data").textContent);
const figures = data.figures;

// A section for each of several.
const each = (several, draw) => (several ?? []).map((_, k) => (all) => draw(all, k));

const sections = [
  summary,
  data.views && frames,
  figures && rig,
  figures?.residuals.length && residuals,
  figures?.projections.length && projections,
  (data.live || data.live_left_out) && live,
  data.board?.cameras.length && data.board.poses.length && boardRig,
  data.board && board,
  ...each(data.selfcals, selfcal),
  ...each(data.plans, plan),
  ...each(data.charts, chart),
  data.atlas && atlas,
  ...each(data.atlas_references, atlasReference),
]
  .filter(Boolean)
  .map((draw) => draw(data));

const links = sections.map((section) => h("li", {}, h("a", { href: "#" + section.id }, section.querySelector("h2").textContent)));

document.head.append(h("style", {}, css));
document
  .getElementById("report")
  .replaceWith(
    h("a", { class: "skip", href: "#main" }, "Skip to the report"),
    h(
      "header",
      {},
      h("h1", {}, data.title),
      h(
        "p",
        {},
        "A report by Laterna. The numbers are those of its files, in four digits; all of them show where a pointer rests.",
      ),
    ),
    h("nav", { "aria-label": "Sections" }, h("ul", {}, links)),
    h("main", { id: "main", tabindex: -1 }, sections),
  );
document.documentElement.dataset.ready = "yes";
