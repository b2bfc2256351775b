// The 3D view: frusta, meshes, points, in the world frame; drag, or arrow keys, + and -.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { h } from "./dom.js";
import { blue, vermilion, orange } from "./colours.js";

/** Rows [R | t] of x_device = R·x + t to the world position of a point in the device's frame. */
function toWorld(rows, point) {
  const d = point.map((value, k) => value - rows[k][3]);
  return [0, 1, 2].map((column) => rows.reduce((sum, row, k) => sum + row[column] * d[k], 0));
}

/** Where a device stands in the world. */
export const centre = (device) => toWorld(device.device_from_world, [0, 0, 0]);

// The image's corners at a depth, without the lens.
function corners(device, depth) {
  const [w, hgt] = device.size;
  return [
    [-0.5, -0.5],
    [w - 0.5, -0.5],
    [w - 0.5, hgt - 0.5],
    [-0.5, hgt - 0.5],
  ].map(([u, v]) =>
    toWorld(device.device_from_world, [((u - device.cx) / device.fx) * depth, ((v - device.cy) / device.fy) * depth, depth]),
  );
}

function frustum(device, depth, colour) {
  const c = centre(device),
    k = corners(device, depth),
    lines = [];
  for (let i = 0; i < 4; ++i) lines.push(c, k[i], k[i], k[(i + 1) % 4]);
  const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(lines.flat(), 3));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({ color: colour }));
}

function meshOf(mesh) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(mesh.positions, 3));
  geometry.setIndex(mesh.triangles);
  return new THREE.Mesh(
    geometry.toNonIndexed(),
    new THREE.MeshStandardMaterial({ color: 0xb8bcc4, side: THREE.DoubleSide, flatShading: true, roughness: 0.9 }),
  );
}

function pointsOf(list) {
  const geometry = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(list, 3));
  return new THREE.Points(
    geometry,
    new THREE.PointsMaterial({ color: orange, size: list.length < 300 ? 7 : 2, sizeAttenuation: false }),
  );
}

// Upwards is what the cameras call up, on the mean.
function upwards(devices) {
  const up = new THREE.Vector3();
  for (const d of devices) up.sub(new THREE.Vector3(...d.device_from_world[1].slice(0, 3)));
  return up.lengthSq() > 1e-6 ? up.normalize() : new THREE.Vector3(0, 0, 1);
}

// From above and beside the devices, so near that all the points just fit.
function place(camera, controls, devices, points) {
  const up = upwards(devices),
    back = new THREE.Vector3();
  for (const d of devices) back.sub(new THREE.Vector3(...d.device_from_world[2].slice(0, 3)));
  back.addScaledVector(up, -back.dot(up));
  if (back.lengthSq() < 1e-6) back.set(up.y, up.z, up.x);
  const side = new THREE.Vector3().crossVectors(up, back.normalize());
  const from = back.clone().multiplyScalar(0.6).addScaledVector(side, 0.8).addScaledVector(up, 0.5).normalize();
  const right = new THREE.Vector3().crossVectors(up, from).normalize(),
    above = new THREE.Vector3().crossVectors(from, right);
  const flat = new THREE.Box3().setFromPoints(points.map((p) => new THREE.Vector3(p.dot(right), p.dot(above), p.dot(from))));
  const middle = flat.getCenter(new THREE.Vector3()),
    slope = Math.tan(THREE.MathUtils.degToRad(camera.fov / 2));
  const distance = Math.max(
    ...points.map(
      (p) =>
        p.dot(from) -
        middle.z +
        Math.max(Math.abs(p.dot(right) - middle.x) / (slope * camera.aspect), Math.abs(p.dot(above) - middle.y) / slope),
    ),
  );
  camera.up.copy(up);
  camera.near = distance / 100;
  camera.far = distance * 100;
  controls.target.copy(right.multiplyScalar(middle.x).addScaledVector(above, middle.y).addScaledVector(from, middle.z));
  camera.position.copy(controls.target).addScaledVector(from, 1.05 * distance);
}

// Arrow keys turn, + and - come nearer and step back.
function keys(camera, controls, draw) {
  return (event) => {
    const spherical = new THREE.Spherical().setFromVector3(turned(camera, controls, false));
    const step = Math.PI / 24;
    if (event.key === "ArrowLeft") spherical.theta -= step;
    else if (event.key === "ArrowRight") spherical.theta += step;
    else if (event.key === "ArrowUp") spherical.phi -= step;
    else if (event.key === "ArrowDown") spherical.phi += step;
    else if (event.key === "+" || event.key === "=") spherical.radius /= 1.15;
    else if (event.key === "-") spherical.radius *= 1.15;
    else return;
    event.preventDefault();
    spherical.makeSafe();
    const offset = new THREE.Vector3().setFromSpherical(spherical).applyQuaternion(upright(camera).invert());
    camera.position.copy(controls.target).add(offset);
    controls.update();
    draw();
  };
}

const upright = (camera) => new THREE.Quaternion().setFromUnitVectors(camera.up, new THREE.Vector3(0, 1, 0));
const turned = (camera, controls) => camera.position.clone().sub(controls.target).applyQuaternion(upright(camera));

/** A canvas to turn. `figures`: {rig, points} as of report_data(); a device may have a colour of its own. */
export function view3d(figures, devices) {
  const canvas = h("canvas", {
    class: "rig",
    tabindex: 0,
    role: "img",
    "aria-label": "The rig in 3D: devices as frusta, meshes, and points. Arrow keys turn it, plus and minus zoom.",
  });
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true, preserveDrawingBuffer: true });
  const scene = new THREE.Scene(),
    camera = new THREE.PerspectiveCamera(35, 16 / 9);
  scene.add(new THREE.HemisphereLight(0xffffff, 0x666677, 2.2));
  const lamp = new THREE.DirectionalLight(0xffffff, 1.4);
  camera.add(lamp);
  scene.add(camera);
  const meshes = figures.rig.meshes.map(meshOf);
  meshes.forEach((mesh) => scene.add(mesh));
  if (figures.points.length) scene.add(pointsOf(figures.points));
  const aim = new THREE.Box3();
  if (figures.points.length) aim.setFromArray(figures.points);
  else meshes.forEach((mesh) => aim.expandByObject(mesh));
  const middle = aim.getCenter(new THREE.Vector3());
  const reach = (d) => new THREE.Vector3(...centre(d)).distanceTo(middle);
  for (const d of figures.rig.projectors) scene.add(frustum(d, reach(d), d.colour ?? vermilion));
  for (const d of figures.rig.cameras) scene.add(frustum(d, reach(d), d.colour ?? blue));
  const controls = new OrbitControls(camera, canvas);
  const corner = (k) => new THREE.Vector3(...[0, 1, 2].map((axis) => (k & (1 << axis) ? aim.max : aim.min).getComponent(axis)));
  place(camera, controls, devices, [
    ...devices.flatMap((d) => [centre(d), ...corners(d, reach(d))].map((p) => new THREE.Vector3(...p))),
    ...Array.from({ length: 8 }, (_, k) => corner(k)),
  ]);
  const draw = () => renderer.render(scene, camera);
  const fit = () => {
    const width = canvas.parentElement?.clientWidth || 860;
    renderer.setPixelRatio(window.devicePixelRatio);
    renderer.setSize(width, Math.round(width * 0.56));
    camera.updateProjectionMatrix();
    controls.update();
    draw();
  };
  controls.addEventListener("change", draw);
  canvas.addEventListener("keydown", keys(camera, controls, draw));
  new ResizeObserver(fit).observe(canvas.parentElement ?? canvas);
  requestAnimationFrame(fit);
  return canvas;
}
