#include "apps/lab/report/svg_rig.h"

#include "apps/lab/chart/svg.h"
#include "calib/correspondences.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace laterna {

using Json = nlohmann::json;

namespace {

constexpr double width = 760, height = 470, border = 40;
constexpr const char *vermilion = "#D55E00", *blue = "#0072B2", *orange = "#E69F00";

using Stroke3 = std::array<glm::dvec3, 2>;

struct Placed {
  glm::dmat3 axes_world;  // columns: the device's x, y, z in the world
  glm::dvec3 centre_world;
};

Placed placed(const Json& device) {
  glm::dmat3 world_from_device;
  glm::dvec3 translation;
  for (int r = 0; r < 3; ++r) {
    const Json& row = device["device_from_world"][r];
    world_from_device[r] = {row[0].get<double>(), row[1].get<double>(), row[2].get<double>()};
    translation[r] = row[3];
  }
  return {world_from_device, -(world_from_device * translation)};
}

std::vector<glm::dvec3> triples(const Json& flat) {
  std::vector<glm::dvec3> points;
  for (std::size_t k = 0; k + 2 < flat.size(); k += 3)
    points.emplace_back(flat[k].get<double>(), flat[k + 1].get<double>(), flat[k + 2].get<double>());
  return points;
}

std::vector<Stroke3> frustum(const Json& device, const glm::dvec3& aim) {
  const Placed p = placed(device);
  const double depth = glm::distance(p.centre_world, aim), w = device["size"][0], h = device["size"][1];
  std::array<glm::dvec3, 4> corner;
  for (int k = 0; k < 4; ++k) {
    const double u = k == 1 || k == 2 ? w - 0.5 : -0.5, v = k >= 2 ? h - 0.5 : -0.5;
    const glm::dvec3 ray((u - device["cx"].get<double>()) / device["fx"].get<double>(),
                         (v - device["cy"].get<double>()) / device["fy"].get<double>(), 1);
    corner[k] = p.centre_world + p.axes_world * (depth * ray);
  }
  std::vector<Stroke3> strokes;
  for (int k = 0; k < 4; ++k)
    strokes.push_back({p.centre_world, corner[k]}), strokes.push_back({corner[k], corner[(k + 1) % 4]});
  return strokes;
}

std::vector<Stroke3> outlines(const Json& mesh) {
  const std::vector<glm::dvec3> at = triples(mesh["positions"]);
  const Json& triangles = mesh["triangles"];
  std::vector<Stroke3> strokes;
  for (const std::size_t t : evenly_spread(triangles.size() / 3, 3000))
    for (std::size_t k = 0; k < 3; ++k)
      strokes.push_back({at.at(triangles[3 * t + k]), at.at(triangles[3 * t + (k + 1) % 3])});
  return strokes;
}

// Right and down on the picture, as directions in the world.
struct Look {
  glm::dvec3 right, down;
};

Look look_of(const Json& rig) {
  glm::dvec3 up(0), back(0);
  for (const char* kind : {"projectors", "cameras"})
    for (const Json& device : rig[kind]) {
      const Placed p = placed(device);
      up -= p.axes_world[1], back -= p.axes_world[2];
    }
  up = glm::length(up) > 1e-3 ? glm::normalize(up) : glm::dvec3(0, 0, 1);
  back -= up * glm::dot(back, up);
  if (glm::length(back) < 1e-3) back = glm::cross(up, glm::dvec3(up.y, up.z, up.x));
  back = glm::normalize(back);
  const glm::dvec3 eye = glm::normalize(0.6 * back + 0.8 * glm::cross(up, back) + 0.5 * up);
  const glm::dvec3 right = glm::normalize(glm::cross(up, eye));
  return {right, glm::cross(right, eye)};
}

// The strokes on the picture, all of them inside its border.
class Sheet {
 public:
  Sheet(const Look& look, const std::vector<Stroke3>& all) : look_(look) {
    for (const Stroke3& s : all)
      for (const glm::dvec3& x : s) low_ = glm::min(low_, flat(x)), high_ = glm::max(high_, flat(x));
    const glm::dvec2 size = glm::max(high_ - low_, 1e-9);
    scale_ = std::min((width - 2 * border) / size.x, (height - 2 * border) / size.y);
  }
  glm::dvec2 place(const glm::dvec3& x) const {
    return glm::dvec2(width, height) / 2.0 + scale_ * (flat(x) - (low_ + high_) / 2.0);
  }
  void draw(Svg& svg, const std::vector<Stroke3>& strokes, const Svg::Stroke& how) const {
    std::vector<std::array<double, 4>> lines;
    for (const Stroke3& s : strokes) {
      const glm::dvec2 from = place(s[0]), to = place(s[1]);
      lines.push_back({from.x, from.y, to.x, to.y});
    }
    svg.strokes(lines, how);
  }

 private:
  glm::dvec2 flat(const glm::dvec3& x) const { return {glm::dot(x, look_.right), glm::dot(x, look_.down)}; }
  Look look_;
  glm::dvec2 low_{INFINITY}, high_{-INFINITY};
  double scale_ = 1;
};

glm::dvec3 middle_of(const std::vector<Stroke3>& strokes) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const Stroke3& s : strokes) low = glm::min(low, s[0]), high = glm::max(high, s[0]);
  return strokes.empty() ? glm::dvec3(0) : (low + high) / 2.0;
}

}  // namespace

std::string rig_svg(const Json& rig, const Json& points) {
  std::vector<Stroke3> meshes, lit, frusta;
  for (const Json& mesh : rig["meshes"]) {
    const std::vector<Stroke3> strokes = outlines(mesh);
    meshes.insert(meshes.end(), strokes.begin(), strokes.end());
  }
  for (const glm::dvec3& x : triples(points)) lit.push_back({x, x});
  const glm::dvec3 aim = middle_of(lit.empty() ? meshes : lit);
  std::vector<Stroke3> all = meshes;
  Svg svg(width, height, "The rig");
  for (const char* kind : {"projectors", "cameras"})
    for (const Json& device : rig[kind]) {
      const std::vector<Stroke3> strokes = frustum(device, aim);
      all.insert(all.end(), strokes.begin(), strokes.end());
    }
  const Sheet sheet(look_of(rig), all);
  sheet.draw(svg, meshes, {neutral_grey, 0.6, "", 0.45});
  sheet.draw(svg, lit, {orange, lit.size() < 100 ? 7.0 : 2.0});
  for (const char* kind : {"projectors", "cameras"})
    for (const Json& device : rig[kind]) {
      sheet.draw(svg, frustum(device, aim), {device.value("colour", kind[0] == 'p' ? vermilion : blue), 1.8});
      const glm::dvec2 at = sheet.place(placed(device).centre_world);
      svg.text(at.x, at.y - 8, device["name"].get<std::string>(), 13, Svg::Anchor::middle);
    }
  svg.text(20, 22, "The rig", 16);
  return svg.str();
}

}  // namespace laterna
