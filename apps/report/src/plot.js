// Observable Plot with this page's looks.
import * as Plot from "@observablehq/plot";
import { format } from "./dom.js";

/** Room for the page's width, at most 860. */
export const plotWidth = () => Math.max(320, Math.min(860, document.documentElement.clientWidth - 48));

// A logarithmic axis with plain numbers in place of 400m and 2k.
const plain = (axis) => (axis?.type === "log" ? { tickFormat: (value) => format(Number(value.toPrecision(3))), ...axis } : axis);
// Side by side, long numbers have room for few ticks.
const belowTicks = (axis) => (axis ? { labelOffset: 38, ...(axis.type === "log" && { ticks: 5 }), ...plain(axis) } : axis);

export function plot(options) {
  return Plot.plot({
    width: plotWidth(),
    style: { background: "transparent", color: "currentColor", fontFamily: "inherit", fontSize: "13px", overflow: "visible" },
    marginBottom: 42,
    ...options,
    x: belowTicks(options.x),
    y: plain(options.y),
  });
}

export * from "@observablehq/plot";
