// Colours that the colour-blind tell apart: Okabe and Ito's for kinds, a cyclic map for directions.
import { interpolateRgbBasisClosed } from "d3-interpolate";

export const blue = "#0072B2",
  vermilion = "#D55E00",
  orange = "#E69F00",
  green = "#009E73",
  sky = "#56B4E9",
  purple = "#CC79A7",
  grey = "#8a8a8a";

export const seriesColours = [blue, vermilion, green, purple, orange, sky];

/** Of devices beside orange points. */
export const deviceColours = [blue, vermilion, green, purple, sky];

export const outcomes = ["right", "weak", "refused", "silent", "crashed"];
export const outcomeColours = { right: "#009E73", weak: "#E69F00", refused: "#56B4E9", silent: "#D55E00", crashed: "#7a3b8f" };
export const outcomeLetters = { right: "r", weak: "w", refused: "f", silent: "S", crashed: "X" };
export const outcomeWords = {
  right: "right",
  weak: "weak and said so",
  refused: "refused with a reason",
  silent: "silently wrong",
  crashed: "crashed",
};

// Gold against violet, orange against blue: no direction relies on red against green, and all read on white and on black.
const wheel = interpolateRgbBasisClosed(["#d9a31f", "#d9601f", "#b03a63", "#7358b8", "#2f80cf", "#45b0b8"]);

/** The colour of a direction, radians. */
export const directionColour = (angle) => wheel((angle / (2 * Math.PI) + 1) % 1);
