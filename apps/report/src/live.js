// The scene itself, drawn by the browser, once it is asked for.
import { h, section } from "./dom.js";
import { show } from "../../live/src/main.js";

export function live(data) {
  const title = "Live view";
  if (!data.live) return section("live", title, h("p", {}, data.live_left_out));
  const stage = h("div", { class: "live" }),
    status = h("p", { role: "status" });
  const start = () => {
    try {
      show(data.live, stage, stage);
      button.remove();
      stage.querySelector("canvas").focus();
    } catch (error) {
      stage.replaceChildren();
      status.textContent = `No live view: ${error.message}.`;
    }
  };
  const button = h("button", { type: "button", onclick: start }, "Start the live view");
  return section(
    "live",
    title,
    h(
      "p",
      {},
      "The true scene as a camera sees it, with projector and camera to move, turn and zoom, and any slide. ",
      data.live.left_out,
    ),
    button,
    status,
    stage,
  );
}
