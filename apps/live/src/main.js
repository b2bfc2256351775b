// The live view: `show` builds it into an element of a page.
import { multiply, rotation, translation } from "./math.js";
import { Renderer } from "./renderer.js";
import { slides } from "./slides.js";

const switches = [
  ["in_front", "g", "q > 0: no light behind the projector"],
  ["border", "b", "border: light ends at the picture's edge (off: edge clamp)"],
  ["back_face", "f", "back faces are dark"],
  ["shadow", "h", "shadow"],
  ["irradiance", "i", "light falls with distance and incidence"],
  ["lighting", "l", "ordinary lighting"],
  ["bilinear", "n", "bilinear lookup"],
  ["frustum", "v", "the projector's frustum"],
];

const deviceOf = (device) => ({
  view: device.projector_from_world,
  clip: device.clip_from_projector,
  size: device.size,
});

/** The scene as it was written: camera `c` sees the light of projector `p`. */
function initialState(scene, c, p) {
  const { flux_lm, border, bilinear } = scene.projectors[p];
  return {
    camera: deviceOf(scene.cameras[c]),
    projector: deviceOf(scene.projectors[p]),
    flux_lm,
    saturation_cd_per_m2: scene.cameras[c].saturation_cd_per_m2[p],
    ...scene.switches,
    border,
    bilinear,
    lighting: false,
    frustum: false,
    slide: 0,
    moves: "projector",
    chosen: { camera: c, projector: p },
  };
}

function element(tag, properties, ...children) {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

// A device's eye frame: x right, y up, looking along -z.
const turn = (device, right, up) => {
  device.view = multiply(rotation(0, -up), rotation(1, right), device.view);
};
const roll = (device, angle) => {
  device.view = multiply(rotation(2, angle), device.view);
};
const move = (device, [right, up, ahead]) => {
  device.view = multiply(translation([-right, -up, ahead]), device.view);
};
// Longer focal lengths, the lens shift stays.
const zoom = (device, factor) => {
  device.clip = device.clip.map((row, i) => row.map((x, j) => (i === j && i < 2 ? x * factor : x)));
};
const fovDegrees = (device) => (360 / Math.PI) * Math.atan(1 / device.clip[1][1]);

const deviceKeys = {
  ArrowLeft: (d) => turn(d, -0.02, 0),
  ArrowRight: (d) => turn(d, 0.02, 0),
  ArrowUp: (d) => turn(d, 0, 0.02),
  ArrowDown: (d) => turn(d, 0, -0.02),
  w: (d, step) => move(d, [0, 0, step]),
  s: (d, step) => move(d, [0, 0, -step]),
  a: (d, step) => move(d, [-step, 0, 0]),
  d: (d, step) => move(d, [step, 0, 0]),
  e: (d, step) => move(d, [0, step, 0]),
  q: (d, step) => move(d, [0, -step, 0]),
  ",": (d) => roll(d, -0.02),
  ".": (d) => roll(d, 0.02),
  "+": (d) => zoom(d, 1.05),
  "=": (d) => zoom(d, 1.05),
  "-": (d) => zoom(d, 1 / 1.05),
};

// Keys that a control under the cursor needs itself.
const hasOwnUse = (control, key) =>
  control.matches("select, textarea, input[type=text], input[type=range], input[type=file]") || (control.matches("input[type=radio]") && key.startsWith("Arrow"));

class LiveView {
  constructor(scene, parent, keysFrom) {
    this.scene = scene;
    this.keysFrom = keysFrom;
    this.state = initialState(scene, 0, 0);
    this.canvas = element("canvas", { tabIndex: 0, ariaLabel: "What the camera sees" });
    const gl = this.canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
    if (!gl) throw new Error("this browser has no WebGL2");
    this.renderer = new Renderer(gl, scene);
    parent.append(this.canvas, this.panel());
    this.listen();
    this.choose(0, 0);
  }

  /** Camera c sees the light of projector p, both where the scene has them; the slide stays where there is such a one. */
  choose(c, p) {
    const { slide, moves } = this.state;
    Object.assign(this.state, initialState(this.scene, c, p), { moves });
    [this.canvas.width, this.canvas.height] = this.state.camera.size;
    this.step = 0.01 * Math.hypot(...this.state.camera.view.map((row) => row[3]).slice(0, 3)); // the camera's distance from the world's origin
    this.slides = slides(this.scene.projectors[p]);
    this.choice.replaceChildren(...this.slides.map((s) => element("option", {}, s.name)));
    this.devices.camera.selectedIndex = c;
    this.devices.projector.selectedIndex = p;
    return this.setSlide(Math.min(slide, this.slides.length - 1));
  }

  // The camera or projector that comes after the chosen one.
  chooseNext(kind) {
    const chosen = { ...this.state.chosen };
    chosen[kind] = (chosen[kind] + 1) % this.devices[kind].length;
    return this.choose(chosen.camera, chosen.projector);
  }

  panel() {
    this.inputs = new Map();
    const labelled = (text, input) => element("label", {}, input, ` ${text}`);
    const moves = ["projector", "camera"].map((which) => {
      const input = element("input", {
        type: "radio",
        name: "moves",
        onchange: () => this.set("moves", which),
        onclick: (event) => event.detail && this.canvas.focus(), // by mouse: the arrow keys then are the device's
      });
      this.inputs.set(which, input);
      return labelled(`${which} (${which === "camera" ? "c" : "p"})`, input);
    });
    this.fov = element("input", {
      type: "range",
      min: 2,
      max: 120,
      step: 0.1,
      oninput: () => {
        const device = this.state[this.state.moves];
        zoom(device, 1 / (Math.tan((Math.PI / 360) * this.fov.valueAsNumber) * device.clip[1][1]));
        this.changed();
      },
    });
    this.fovText = element("output", {});
    this.choice = element("select", { onchange: () => this.setSlide(this.choice.selectedIndex) });
    this.devices = Object.fromEntries(
      ["camera", "projector"].map((kind) => [
        kind,
        element(
          "select",
          { onchange: () => this.choose(this.devices.camera.selectedIndex, this.devices.projector.selectedIndex) },
          ...this.scene[`${kind}s`].map((device) => element("option", {}, device.name)),
        ),
      ]),
    );
    const several = ["camera", "projector"].filter((kind) => this.devices[kind].length > 1);
    const file = element("input", { type: "file", accept: "image/*", onchange: () => this.showFile(file.files[0]) });
    const boxes = switches.map(([name, key, text]) => {
      const input = element("input", { type: "checkbox", onchange: () => this.set(name, input.checked) });
      this.inputs.set(name, input);
      return labelled(`${text} (${key})`, input);
    });
    return element(
      "form",
      { onsubmit: (event) => event.preventDefault() },
      ...several.map((kind) => labelled(`${kind} (${kind === "camera" ? "k" : "j"} for the next)`, this.devices[kind])),
      element("fieldset", {}, element("legend", {}, "Moves and turns"), ...moves),
      labelled("vertical field of view ", this.fov),
      this.fovText,
      labelled("slide (m, and o back)", this.choice),
      labelled("or a picture", file),
      element("fieldset", {}, element("legend", {}, "Switches"), ...boxes),
      element("button", { type: "button", onclick: () => this.reset() }, "as the scene says (r)"),
      element(
        "p",
        {},
        "Drag to turn, with Shift to move, the wheel to go ahead. Keys: w a s d e q move, arrows turn, comma and full stop roll, + and - change the field of view.",
      ),
    );
  }

  listen() {
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
    canvas.addEventListener("pointermove", (event) => {
      if (!event.buttons) return;
      const device = this.state[this.state.moves];
      if (event.shiftKey) move(device, [-0.1 * this.step * event.movementX, 0.1 * this.step * event.movementY, 0]);
      else turn(device, 0.002 * event.movementX, -0.002 * event.movementY);
      this.changed();
    });
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        move(this.state[this.state.moves], [0, 0, -this.step * Math.sign(event.deltaY)]);
        this.changed();
      },
      { passive: false },
    );
    this.keysFrom.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.altKey || event.metaKey || hasOwnUse(event.target, event.key)) return;
      if (this.key(event.key)) event.preventDefault();
    });
  }

  /** Does what a key stands for; false where it stands for nothing. */
  key(key) {
    const act = deviceKeys[key],
      flag = switches.find(([, of]) => of === key);
    if (act) act(this.state[this.state.moves], this.step);
    else if (flag) return this.set(flag[0], !this.state[flag[0]]);
    else if (key === "c" || key === "p") return this.set("moves", key === "c" ? "camera" : "projector");
    else if (key === "m" || key === "o")
      return this.setSlide((this.state.slide + (key === "m" ? 1 : this.slides.length - 1)) % this.slides.length);
    else if (key === "k" || key === "j") return this.chooseNext(key === "k" ? "camera" : "projector");
    else if (key === "r") return this.reset();
    else return false;
    return this.changed();
  }

  set(name, value) {
    this.state[name] = value;
    if (name === "bilinear") this.renderer.setSlide(this.picture, value);
    return this.changed();
  }

  reset() {
    return this.choose(this.state.chosen.camera, this.state.chosen.projector);
  }

  setSlide(index) {
    this.state.slide = this.choice.selectedIndex = index;
    return this.show(this.slides[index].picture());
  }

  async showFile(file) {
    if (file) this.show(await createImageBitmap(file, { imageOrientation: "flipY", colorSpaceConversion: "none" }));
  }

  show(picture) {
    this.picture = picture;
    this.renderer.setSlide(picture, this.state.bilinear);
    return this.changed();
  }

  // One frame for all changes until then.
  changed() {
    if (!this.pending)
      this.pending = requestAnimationFrame(() => {
        this.pending = 0;
        this.draw();
      });
    return true;
  }

  draw() {
    const { state, canvas } = this;
    for (const [name] of switches) this.inputs.get(name).checked = state[name];
    this.inputs.get(state.moves).checked = true;
    this.fov.valueAsNumber = fovDegrees(state[state.moves]);
    this.fovText.textContent = `${fovDegrees(state[state.moves]).toFixed(1)}°`;
    this.renderer.draw(state, null, canvas.width, canvas.height, true);
  }
}

/** Builds the view into `parent`; keys act where `keysFrom` hears them. */
export const show = (scene, parent, keysFrom = document) => new LiveView(scene, parent, keysFrom);
