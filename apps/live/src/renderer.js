// Draws what a camera sees of a projector's light, in WebGL2.
import { apply, cross, determinant, floats, inverseRigid, length, minus, multiply, translation } from "./math.js";
import { depthShader, lightShader, lineShader, vertexShader } from "./shaders.js";

const shadowMapPx = 2048;

function program(gl, fragment) {
  const made = gl.createProgram();
  for (const [kind, source] of [
    [gl.VERTEX_SHADER, vertexShader],
    [gl.FRAGMENT_SHADER, fragment],
  ]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
  const at = new Map();
  return {
    made,
    at: (name) => at.get(name) ?? at.set(name, gl.getUniformLocation(made, name)).get(name),
  };
}

function attribute(gl, index, values) {
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, values, gl.STATIC_DRAW);
  gl.vertexAttribPointer(index, 3, gl.FLOAT, false, 0, 0);
  gl.enableVertexAttribArray(index);
}

const bytesOf = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0)).buffer;

/** A mesh with its numbers as arrays. */
const unpacked = (mesh) => ({
  ...mesh,
  positions: new Float32Array(bytesOf(mesh.positions)),
  triangles: new Uint32Array(bytesOf(mesh.triangles)),
});

// Three vertices for each triangle, with its flat normal in the world, towards its front side.
function upload(gl, mesh) {
  const positions = new Float32Array(mesh.triangles.length * 3),
    normals = new Float32Array(positions.length);
  const corner = (t, i) => mesh.positions.subarray(3 * mesh.triangles[3 * t + i], 3 * mesh.triangles[3 * t + i] + 3);
  const world = (x) => apply(mesh.world_from_object, [...x]).slice(0, 3);
  const mirrored = determinant(mesh.world_from_object) < 0;
  for (let t = 0; t < mesh.triangles.length / 3; ++t) {
    const corners = [corner(t, 0), corner(t, 1), corner(t, 2)],
      [a, b, c] = corners.map(world);
    const across = cross(minus(b, a), minus(c, a)),
      scale = (mirrored ? -1 : 1) / (length(across) || 1);
    corners.forEach((x, i) => {
      positions.set(x, 9 * t + 3 * i);
      normals.set(
        across.map((n) => n * scale),
        9 * t + 3 * i,
      );
    });
  }
  const array = gl.createVertexArray();
  gl.bindVertexArray(array);
  attribute(gl, 0, positions);
  attribute(gl, 1, normals);
  return { array, count: positions.length / 3, mirrored };
}

// The eight corners of a mesh's box, in the world.
function corners(mesh) {
  const low = [Infinity, Infinity, Infinity],
    high = [-Infinity, -Infinity, -Infinity];
  mesh.positions.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  return [0, 1, 2, 3, 4, 5, 6, 7].map((k) =>
    apply(mesh.world_from_object, [0, 1, 2].map((i) => ((k >> i) & 1 ? high : low)[i])).slice(0, 3),
  );
}

/** P of a device with its r row for planes that hold all of the points; T's other rows do not change. */
function clipAround(device, points) {
  const depths = points.map((x) => -apply(device.view, x)[2]);
  const far = Math.max(1.01 * Math.max(...depths), 1e-3),
    near = Math.max(0.99 * Math.min(...depths), 1e-3 * far);
  return [device.clip[0], device.clip[1], [0, 0, -(far + near) / (far - near), (-2 * far * near) / (far - near)], device.clip[3]];
}

export class Renderer {
  constructor(gl, scene) {
    Object.assign(this, { gl, scene });
    this.depth = program(gl, depthShader);
    this.light = program(gl, lightShader);
    this.line = program(gl, lineShader);
    this.objects = scene.meshes.map(unpacked).map((mesh) => ({ mesh, ...upload(gl, mesh) }));
    this.points = this.objects.flatMap(({ mesh }) => corners(mesh));
    this.makeShadowMap();
    this.slide = gl.createTexture();
    this.lines = { array: gl.createVertexArray(), buffer: gl.createBuffer() };
  }

  makeShadowMap() {
    const gl = this.gl;
    this.shadowMap = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.shadowMap);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT32F, shadowMapPx, shadowMapPx);
    for (const [key, value] of [
      [gl.TEXTURE_MIN_FILTER, gl.NEAREST],
      [gl.TEXTURE_MAG_FILTER, gl.NEAREST],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE],
      [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
      [gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE],
      [gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL],
    ])
      gl.texParameteri(gl.TEXTURE_2D, key, value);
    this.shadowFrame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadowMap, 0);
  }

  /** `picture`: { width, height, rgba }, its highest row first, or an image of the page's. */
  setSlide(picture, bilinear) {
    const gl = this.gl,
      filter = bilinear ? gl.LINEAR : gl.NEAREST;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.slide);
    gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, true); // our first row is the highest, OpenGL's the lowest
    if (picture.rgba)
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, picture.width, picture.height, 0, gl.RGBA, gl.UNSIGNED_BYTE, picture.rgba);
    else gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  }

  drawObjects(prepare) {
    const gl = this.gl;
    for (const object of this.objects) {
      gl.frontFace(object.mirrored ? gl.CW : gl.CCW);
      prepare(object.mesh);
      gl.bindVertexArray(object.array);
      gl.drawArrays(gl.TRIANGLES, 0, object.count);
    }
  }

  drawShadowMap(clipFromWorld) {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.viewport(0, 0, shadowMapPx, shadowMapPx);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.depth.made);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 4);
    this.drawObjects((mesh) =>
      gl.uniformMatrix4fv(this.depth.at("clip_from_object"), false, floats(multiply(clipFromWorld, mesh.world_from_object))),
    );
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  setSwitches(state, forPeople) {
    const gl = this.gl,
      { at } = this.light;
    gl.uniform1i(at("slide"), 0);
    gl.uniform1i(at("depth_map"), 1);
    for (const name of ["in_front", "border", "back_face", "shadow", "irradiance"]) gl.uniform1i(at(name), state[name]);
    gl.uniform1i(at("for_people"), forPeople);
    gl.uniform1f(at("lamp"), state.lighting ? 0.35 : 0);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.shadowMap);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.slide);
  }

  /**
   * Draws into `frame` (null: the page). `state`: camera and projector, each { view, clip, size }, where clip holds
   * the first two rows and the last of P; flux_lm, saturation_cd_per_m2 and the switches. T = B·P·V·M is composed in double.
   */
  draw(state, frame, width, height, forPeople) {
    const gl = this.gl,
      { camera, projector } = state,
      { scene, points } = this;
    const projectorClip = multiply(clipAround(projector, points), projector.view),
      cameraClip = multiply(clipAround(camera, points), camera.view);
    const position = inverseRigid(projector.view).map((row) => row[3]);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(0, 0, 0, forPeople ? 1 : 0);
    if (state.shadow) this.drawShadowMap(projectorClip);
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.useProgram(this.light.made);
    this.setSwitches(state, forPeople);
    // Focal lengths in pixels times flux per pixel: flux·P00·P11/4, for each steradian-like unit of (x/z, y/z).
    const white = (state.flux_lm * projector.clip[0][0] * projector.clip[1][1]) / 4 / Math.PI / state.saturation_cd_per_m2;
    this.drawObjects((mesh) => {
      const m = mesh.world_from_object;
      for (const [name, matrix] of [
        ["clip_from_object", multiply(cameraClip, m)],
        ["texture_from_object", multiply(scene.texture_from_clip, projectorClip, m)],
        ["ray_from_object", multiply(translation(position.slice(0, 3).map((x) => -x)), m)],
        ["eye_from_object", multiply(translation(inverseRigid(camera.view).map((row) => -row[3]).slice(0, 3)), m)],
      ])
        gl.uniformMatrix4fv(this.light.at(name), false, floats(matrix));
      gl.uniform1f(this.light.at("white"), white * mesh.albedo);
      gl.uniform1f(this.light.at("ambient"), (scene.ambient_lx * mesh.albedo) / Math.PI / state.saturation_cd_per_m2);
    });
    if (state.frustum && forPeople) this.drawFrustum(projector, cameraClip);
  }

  // The projector's four edges, as far as the scene's far side.
  drawFrustum(projector, cameraClip) {
    const gl = this.gl,
      back = inverseRigid(projector.view),
      far = Math.max(...this.points.map((x) => -apply(projector.view, x)[2]), 1e-3);
    const edge = ([x, y]) =>
      apply(back, [((x + projector.clip[0][2]) / projector.clip[0][0]) * far, ((y + projector.clip[1][2]) / projector.clip[1][1]) * far, -far]);
    const tips = [
        [-1, -1],
        [1, -1],
        [1, 1],
        [-1, 1],
      ].map((c) => edge(c).slice(0, 3)),
      apex = back.map((row) => row[3]).slice(0, 3);
    const vertices = new Float32Array(tips.flatMap((tip, i) => [...apex, ...tip, ...tip, ...tips[(i + 1) % 4]]));
    gl.useProgram(this.line.made);
    gl.uniformMatrix4fv(this.line.at("clip_from_object"), false, floats(cameraClip));
    gl.bindVertexArray(this.lines.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.lines.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.DYNAMIC_DRAW);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    gl.enableVertexAttribArray(0);
    gl.drawArrays(gl.LINES, 0, vertices.length / 3);
  }

  /** The camera's own picture, in digital numbers: RGB and, as alpha, 255 where lit; the highest row first. */
  picture(state) {
    const gl = this.gl,
      [width, height] = state.camera.size;
    const frame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    for (const [where, format] of [
      [gl.COLOR_ATTACHMENT0, gl.RGBA8],
      [gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT32F],
    ]) {
      const buffer = gl.createRenderbuffer();
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, where, gl.RENDERBUFFER, buffer);
    }
    this.draw(state, frame, width, height, false);
    const flipped = new Uint8Array(4 * width * height),
      rgba = new Uint8Array(flipped.length);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, flipped);
    for (let y = 0; y < height; ++y)
      rgba.set(flipped.subarray(4 * width * (height - 1 - y), 4 * width * (height - y)), 4 * width * y);
    return { width, height, rgba };
  }
}
