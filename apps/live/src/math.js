// 4×4 matrices as arrays of rows, column vectors, in double precision: as `laterna info --json` writes them.

export const identity = () => [0, 1, 2, 3].map((i) => [0, 1, 2, 3].map((j) => Number(i === j)));

export const multiply = (...factors) =>
  factors.reduce((a, b) => a.map((row) => [0, 1, 2, 3].map((j) => row.reduce((sum, x, k) => sum + x * b[k][j], 0))));

export const apply = (m, [x, y, z]) => m.map((row) => row[0] * x + row[1] * y + row[2] * z + row[3]);

/** What OpenGL takes: floats, column by column. The one place where precision goes. */
export const floats = (m) => new Float32Array([0, 1, 2, 3].flatMap((j) => m.map((row) => row[j])));

export const translation = ([x, y, z]) => [
  [1, 0, 0, x],
  [0, 1, 0, y],
  [0, 0, 1, z],
  [0, 0, 0, 1],
];

/** About axis 0 (x), 1 (y) or 2 (z). */
export function rotation(axis, angle) {
  const m = identity(),
    a = (axis + 1) % 3,
    b = (axis + 2) % 3;
  m[a][a] = m[b][b] = Math.cos(angle);
  m[b][a] = Math.sin(angle);
  m[a][b] = -m[b][a];
  return m;
}

/** Of a rotation and a translation. */
export function inverseRigid(m) {
  const turned = [0, 1, 2].map((i) => [m[0][i], m[1][i], m[2][i], 0]).concat([[0, 0, 0, 1]]);
  return multiply(turned, translation([-m[0][3], -m[1][3], -m[2][3]]));
}

export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const minus = (a, b) => a.map((x, i) => x - b[i]);
export const length = (a) => Math.hypot(...a);

/** Of the left 3×3 block. */
export const determinant = (m) => cross(m[0].slice(0, 3), m[1].slice(0, 3)).reduce((sum, x, i) => sum + x * m[2][i], 0);
