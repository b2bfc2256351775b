// What the projector can show: the scene's patterns, and the classic demos' slides.

function slide([width, height], colourAt) {
  const rgba = new Uint8Array(4 * width * height);
  for (let v = 0; v < height; ++v)
    for (let u = 0; u < width; ++u) {
      const at = 4 * (v * width + u);
      rgba.set(colourAt(u, v), at);
      rgba[at + 3] = 255;
    }
  return { width, height, rgba };
}

// 1 in the middle, 0 at a share `radius` of the shorter side.
const spot = ([w, h], radius, sharpness) => (u, v) => {
  const r = Math.hypot(u - (w - 1) / 2, v - (h - 1) / 2) / (radius * Math.min(w, h));
  return Math.max(0, 1 - r ** sharpness);
};

const grey = (value) => [value, value, value];

function pattern(size, { axis, values }) {
  const line = values.match(/../g).map((hex) => parseInt(hex, 16));
  return slide(size, (u, v) => grey(line[axis ? v : u]));
}

/** A list of { name, picture() }. */
export function slides({ size, patterns }) {
  const flashlight = spot(size, 0.45, 3),
    coloured = spot(size, 0.45, 12);
  const tints = [
    [255, 70, 50],
    [70, 230, 80],
    [80, 120, 255],
    [255, 210, 60],
  ];
  return [
    { name: "white", picture: () => slide(size, () => grey(255)) },
    { name: "flashlight", picture: () => slide(size, (u, v) => grey(255 * flashlight(u, v))) },
    {
      name: "coloured spot",
      picture: () =>
        slide(size, (u, v) => tints[2 * (v > size[1] / 2) + (u > size[0] / 2)].map((c) => c * coloured(u, v))),
    },
    { name: "chequers", picture: () => slide(size, (u, v) => grey(((u >> 6) ^ (v >> 6)) & 1 ? 255 : 20)) },
    ...patterns.map((p) => ({ name: `pattern: ${p.name}`, picture: () => pattern(size, p) })),
  ];
}
