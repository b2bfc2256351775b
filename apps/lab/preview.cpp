#include "apps/lab/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace laterna {

namespace {

constexpr Rgb background{24, 26, 30}, ink{235, 235, 235}, camera_colour{120, 200, 255};
constexpr std::array<Rgb, 4> projector_colours{
    {{255, 196, 64}, {255, 110, 130}, {140, 230, 120}, {200, 140, 255}}};

// The box around what the cameras see; around the meshes where they see nothing.
Box seen_box(const Scene& scene, const Traced& traced) {
  Box box{glm::dvec3(HUGE_VAL), glm::dvec3(-HUGE_VAL)};
  const auto extend = [&](const glm::dvec3& x) { box = {glm::min(box.low, x), glm::max(box.high, x)}; };
  for (std::size_t c = 0; c < traced.surfaces.size(); ++c) {
    for (std::size_t i = 0; i < traced.surfaces[c].object.values.size(); ++i) {
      if (traced.surfaces[c].hit(i)) extend(traced.points_world[c].values[i]);
    }
  }
  if (box.low.x <= box.high.x) return box;
  for (const Object& object : scene.objects) {
    for (const glm::dvec3& x : object.mesh.positions)
      extend(glm::dvec3(object.world_from_object * glm::dvec4(x, 1)));
  }
  return box;
}

// The corners of a box and the devices' centres: what the outside view must hold.
std::vector<glm::dvec3> landmarks(const Scene& scene, const Box& seen) {
  std::vector<glm::dvec3> points;
  for (int k = 0; k < 8; ++k) {
    points.emplace_back(k & 1 ? seen.high.x : seen.low.x, k & 2 ? seen.high.y : seen.low.y,
                        k & 4 ? seen.high.z : seen.low.z);
  }
  for (const Projector& p : scene.projectors) points.push_back(center_in_world(p.device.device_from_world));
  for (const Camera& c : scene.cameras) points.push_back(center_in_world(c.device.device_from_world));
  return points;
}

// Where the outside view looks from, as a direction from the scene: aside of the mean line of sight, a little
// behind the devices and above, with the cameras' mean upwards as up.
struct Viewpoint {
  glm::dvec3 direction, up;
};
Viewpoint viewpoint(const Scene& scene) {
  glm::dvec3 sight(0.0), up(0.0);
  for (const Projector& p : scene.projectors) sight += glm::transpose(p.device.device_from_world.rotation)[2];
  for (const Camera& c : scene.cameras) {
    const glm::dmat3 axes = glm::transpose(c.device.device_from_world.rotation);
    sight += axes[2];
    up -= axes[1];
  }
  up = glm::length(up) > 1e-6 ? glm::normalize(up) : glm::dvec3(0, 0, 1);
  glm::dvec3 right = glm::cross(sight, up);
  right = glm::length(right) > 1e-6 ? glm::normalize(right)
                                    : glm::normalize(glm::cross(up, glm::dvec3(0.6, 0.8, 0.1)));
  const glm::dvec3 backwards = glm::normalize(glm::cross(right, up));
  return {glm::normalize(0.75 * right + 0.6 * backwards + 0.5 * up), up};
}

// Steps back until every landmark lies well inside the picture.
Camera observer(const Scene& scene, const Box& seen, glm::ivec2 size) {
  const std::vector<glm::dvec3> points = landmarks(scene, seen);
  glm::dvec3 low = points[0], high = points[0];
  for (const glm::dvec3& x : points) low = glm::min(low, x), high = glm::max(high, x);
  const glm::dvec3 centre = 0.5 * (low + high);
  const Viewpoint from = viewpoint(scene);
  Camera camera;
  camera.device.name = "observer";
  camera.device.intrinsics =
      intrinsics_from_fov_y(size, 30 * std::numbers::pi / 180, double(size.x) / size.y);
  const auto fits = [&] {
    const WorldProjection eye(camera.device);
    return std::all_of(points.begin(), points.end(), [&](const glm::dvec3& x) {
      const glm::dvec3 uvq = eye.project(x);
      return uvq.z > 0 && std::abs(uvq.x / size.x - 0.5) < 0.44 && std::abs(uvq.y / size.y - 0.5) < 0.44;
    });
  };
  double distance = std::max(1e-6, glm::length(high - low));
  for (int k = 0; k < 60; ++k, distance *= 1.05) {
    camera.device.device_from_world =
        device_from_world_looking_at(centre + distance * from.direction, centre, from.up);
    if (fits()) break;
  }
  return camera;
}

Rgb mix(Rgb a, Rgb b, double share) {
  Rgb c{};
  for (int i = 0; i < 3; ++i) c[i] = std::uint8_t(std::lround(a[i] + share * (b[i] - a[i])));
  return c;
}

// A picture of what a device sees: grey by the angle to the viewer, tinted where projectors light it.
struct Shading {
  glm::dvec3 eye_world;
  const SurfaceMap& surface;
  PixelArray<glm::dvec3> points, normals;
  std::vector<const LightMap*> lights;

  Rgb operator()(int x, int y) const {
    const std::size_t i = points.index(x, y);
    if (!surface.hit(i)) return background;
    const double facing = std::abs(glm::dot(glm::normalize(eye_world - points.values[i]), normals.values[i]));
    const auto level = std::uint8_t(45 + 150 * facing);
    Rgb colour{level, level, level};
    for (std::size_t p = 0; p < lights.size(); ++p) {
      if (!lights[p]->lit(i)) continue;
      const Rgb tint = projector_colours[p % projector_colours.size()];
      const auto shaded = [&](int k) { return std::uint8_t(tint[k] * level / 195); };
      colour = mix(colour, {shaded(0), shaded(1), shaded(2)}, 0.65);
    }
    return colour;
  }
};

// Four edges from the centre to the picture's corners at a depth, the picture's outline there, and its upper
// edge thicker.
void draw_frustum(Canvas& canvas, glm::ivec2 corner, const WorldProjection& eye, const Device& device,
                  double depth_m, Rgb colour) {
  const WorldProjection own(device);
  const glm::ivec2 size = device.intrinsics.size;
  const auto place = [&](const glm::dvec3& x) { return glm::dvec2(eye.project(x)) + glm::dvec2(corner); };
  const auto line = [&](const glm::dvec3& a, const glm::dvec3& b, int thickness) {
    const glm::dvec2 from = place(a), to = place(b);
    if (std::isfinite(from.x) && std::isfinite(to.x)) draw_line(canvas, from, to, colour, thickness);
  };
  const std::array<glm::dvec2, 4> pixels{
      {{-0.5, -0.5}, {size.x - 0.5, -0.5}, {size.x - 0.5, size.y - 0.5}, {-0.5, size.y - 0.5}}};
  std::array<std::optional<glm::dvec3>, 4> corners;
  for (int k = 0; k < 4; ++k) corners[k] = own.unproject(pixels[k], depth_m);
  const glm::dvec3 centre = center_in_world(device.device_from_world);
  for (int k = 0; k < 4; ++k) {
    if (corners[k]) line(centre, *corners[k], 1);
    if (corners[k] && corners[(k + 1) % 4]) line(*corners[k], *corners[(k + 1) % 4], k == 0 ? 3 : 1);
  }
  const glm::dvec2 at = place(centre);
  if (std::isfinite(at.x)) draw_text(canvas, glm::ivec2(at) + glm::ivec2(8, -16), device.name, 12, colour);
}

void draw_outside(Canvas& canvas, const Scene& given, const Traced& traced, glm::ivec2 corner,
                  glm::ivec2 size) {
  const Scene& scene = traced.as_seen(given);
  const Box seen = seen_box(scene, traced);
  const Camera eye = observer(scene, seen, size);
  const SurfaceMap surface = trace_surface(traced.rays, scene, eye);
  std::vector<LightMap> lights;
  for (const Projector& p : scene.projectors) lights.push_back(trace_light(traced.rays, scene, surface, p));
  std::vector<const LightMap*> pointers;
  for (const LightMap& light : lights) pointers.push_back(&light);
  draw_panel(canvas, corner, size, size,
             Shading{center_in_world(eye.device.device_from_world), surface, points_world(surface, scene),
                     normals_world(surface, traced.rays), pointers});
  const WorldProjection projection(eye.device);
  const glm::dvec3 centre = 0.5 * (seen.low + seen.high);
  const auto depth = [&](const Device& device) {
    return std::max(1e-6, apply(device.device_from_world, centre).z);
  };
  for (std::size_t p = 0; p < scene.projectors.size(); ++p) {
    const Device& device = scene.projectors[p].device;
    draw_frustum(canvas, corner, projection, device, depth(device),
                 projector_colours[p % projector_colours.size()]);
  }
  for (const Camera& c : scene.cameras)
    draw_frustum(canvas, corner, projection, c.device, depth(c.device), camera_colour);
}

}  // namespace

std::string overlap_text(const Scene& scene, const Traced& traced) {
  std::string text;
  for (const View& view : traced.views) {
    const Overlap share = overlap(scene, traced, view);
    text += fmt::format(
        "\"{}\" sees {:.1f} % of what it looks at lit by \"{}\", and {:.1f} % of that projector's picture\n",
        scene.cameras[view.camera].device.name, share.camera_lit,
        scene.projectors[view.projector].device.name, share.projector_seen);
  }
  return text;
}

Canvas preview_picture(const Scene& scene, const Traced& traced) {
  const glm::ivec2 outside(960, 720);
  const int cameras = std::min<int>(3, int(scene.cameras.size()));
  const glm::ivec2 panel(560, (outside.y - 30 * cameras) / cameras);
  Canvas canvas(outside.x + panel.x + 30, outside.y + 70, background);
  draw_text(canvas, {12, 10}, "The rig from outside", 14, ink);
  draw_outside(canvas, scene, traced, {10, 34}, outside);
  const std::size_t projectors = scene.projectors.size();
  for (int c = 0; c < cameras; ++c) {
    const glm::ivec2 corner(outside.x + 20, 34 + c * (panel.y + 30));
    std::vector<const LightMap*> lights;
    std::string words = "\"" + scene.cameras[c].device.name + "\" sees";
    for (std::size_t p = 0; p < projectors; ++p) {
      const View& view = traced.views[std::size_t(c) * projectors + p];
      lights.push_back(&view.light);
      words += fmt::format("  {}: {:.0f} % lit", scene.projectors[p].device.name,
                           overlap(scene, traced, view).camera_lit);
    }
    const SurfaceMap& surface = traced.surfaces[c];
    draw_text(canvas, corner - glm::ivec2(0, 24), words, 14, ink);
    draw_panel(canvas, corner, panel, {surface.width, surface.height},
               Shading{center_in_world(scene.cameras[c].device.device_from_world), surface,
                       traced.points_world[c], normals_world(surface, traced.rays), lights});
  }
  draw_text(canvas, {12, outside.y + 44},
            "blue: cameras; other colours: projectors and their light; thick edge: top of the picture", 12,
            ink);
  return canvas;
}

}  // namespace laterna
