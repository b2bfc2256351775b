#include "apps/lab/classics/projected_light.h"

#include "apps/lab/classics/demo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace laterna {

namespace {

/// OpenGL's matrix stack, as the tutorial builds its texture matrix with it: the last one multiplied is the
/// first applied.
class MatrixStack {
 public:
  MatrixStack& multiply(const glm::dmat4& matrix) {
    top_ = top_ * matrix;
    return *this;
  }
  const glm::dmat4& top() const { return top_; }

 private:
  glm::dmat4 top_{1.0};
};

/// B · P_light · V_light · V_camera⁻¹, for coordinates in the camera's view.
glm::dmat4 texture_from_view(const Device& light, const Device& camera) {
  return MatrixStack()
      .multiply(texture_from_clip())
      .multiply(clip_from_projector(light.intrinsics, light.planes))
      .multiply(projector_from_world(light.device_from_world))
      .multiply(glm::inverse(projector_from_world(camera.device_from_world)))
      .top();
}

/// (s, t, r, q) by the stack, of what each pixel sees.
PixelArray<glm::dvec4> stack_coordinates(const ClassicDemo& demo) {
  const Device& camera = demo.scene.cameras[0].device;
  const glm::dmat4 texture = texture_from_view(demo.projector().device, camera);
  const glm::dmat4 view = projector_from_world(camera.device_from_world);
  const auto points = points_world(demo.view.surface, demo.scene);
  PixelArray<glm::dvec4> strq(points.width, points.height);
  for (std::size_t p = 0; p < points.values.size(); ++p)
    strq.values[p] = texture * (view * glm::dvec4(points.values[p], 1.0));
  return strq;
}

/// Pixels behind the projector that are brighter than in `dark`, as a share of all.
double share_behind(const ClassicDemo& demo, const Image<double>& picture) {
  const double dark = demo.scene.ambient_lx / demo.full_lx;
  std::size_t count = 0;
  for (std::size_t p = 0; p < picture.values.size(); ++p)
    count += Unlit(demo.view.lights[0].why.values[p]) == Unlit::behind && picture.values[p] > dark + 1e-6;
  return double(count) / double(picture.values.size());
}

void show_q_test(const ClassicDemo& demo, ClassicResult& result) {
  const Image<double> without = demo.passes({.tests = {.q = false, .r = false}, .back_face = false}).back();
  const Image<double> with = demo.passes({.tests = {.r = false}, .back_face = false}).back();
  result.pictures.push_back(
      {"projected_light_q", side_by_side({{"no test of q", shown(without)}, {"q > 0", shown(with)}}, 2)});
  result.figures.insert(result.figures.end(),
                        {{"light behind the projector, no test of q", share_behind(demo, without), "", 1e-3},
                         {"light behind the projector, q > 0", share_behind(demo, with), "", 0}});
}

void show_border(const ClassicDemo& demo, const std::filesystem::path& file, ClassicResult& result) {
  const Image<double> smear = demo.passes({.tests = {.st = false}}).back();
  const Image<double> killed = demo.passes({}).back();
  const ClassicDemo core(file, {"effects.border=false"});
  result.pictures.push_back(
      {"projected_light_border",
       side_by_side({{"clamped to the edge: the smear", shown(smear)}, {"border", shown(killed)}}, 2)});
  result.figures.insert(
      result.figures.end(),
      {{"pixels of the smear", share_that_differs(smear, killed), "", 1e-3},
       {"the smear to the core's `border = false`, greatest", greatest_difference(smear, core.core()), "",
        1e-6},
       {"border to the core's picture, greatest", greatest_difference(killed, demo.core()), "", 1e-6}});
}

/// How wide the lit part of the wall is, in metres, along the wall.
double lit_width_m(const ClassicDemo& demo) {
  const auto points = points_world(demo.view.surface, demo.scene);
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (std::size_t p = 0; p < points.values.size(); ++p) {
    if (demo.view.surface.object.values[p] != 1 || !demo.view.lights[0].lit(p)) continue;
    least = std::min(least, points.values[p].y), most = std::max(most, points.values[p].y);
  }
  return most - least;
}

// The torch turned to face the wall, 3.4 m away: its picture is 2·3.4·tan(fov/2) wide there.
void show_fov(const std::filesystem::path& file, ClassicResult& result) {
  std::vector<Panel> panels;
  for (const int fov_deg : {20, 40, 60}) {
    const ClassicDemo demo(
        file, {fmt::format("projector.fov_y_deg={}", fov_deg), "projector.position=[0.8, 0.5, 1.5]",
               "projector.look_at=[-2.6, 0.5, 1.5]"});
    panels.push_back({fmt::format("{} degrees", fov_deg), shown(demo.passes({}).back())});
    const double width_m = 2 * 3.4 * std::tan(glm::radians(fov_deg / 2.0));
    result.figures.push_back({fmt::format("width on the wall at {}°, over 2z·tan(fov/2)", fov_deg),
                              lit_width_m(demo) / width_m, "", 1e-3});
  }
  result.pictures.push_back({"projected_light_fov", side_by_side(panels, 3)});
}

/// The core's picture with light of a colour on white ambient light.
Image<glm::vec3> in_colour(const ClassicDemo& demo, const glm::dvec3& colour) {
  const Image<double> picture = demo.core();
  const double dark = demo.scene.ambient_lx / demo.full_lx;
  Image<glm::vec3> light(picture.width, picture.height);
  for (std::size_t p = 0; p < light.values.size(); ++p) {
    const double from_ambient = std::min(picture.values[p], dark);
    light.values[p] = glm::vec3(glm::dvec3(from_ambient) + colour * (picture.values[p] - from_ambient));
  }
  return light;
}

/// Angle from the projector's axis of what each pixel sees; NaN where it is not lit.
std::vector<double> angles_rad(const ClassicDemo& demo) {
  const auto points = points_world(demo.view.surface, demo.scene);
  const Rigid& pose = demo.projector().device.device_from_world;
  std::vector<double> angles(points.values.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t p = 0; p < angles.size(); ++p) {
    if (!demo.view.lights[0].lit(p)) continue;
    const glm::dvec3 x = apply(pose, points.values[p]);
    angles[p] = std::atan2(std::hypot(x.x, x.y), x.z);
  }
  return angles;
}

/// Of the three channels, against colour·cosⁿθ of the light that the same projector gives without a spot.
double distance_from_law(const Image<glm::vec3>& spot, const ClassicDemo& open,
                         const std::vector<double>& angles, const glm::dvec3& colour, double exponent) {
  const Image<double> bare = open.core();
  const double dark = open.scene.ambient_lx / open.full_lx;
  double most = 0;
  for (std::size_t p = 0; p < angles.size(); ++p) {
    if (std::isnan(angles[p])) continue;
    const double light = (bare.values[p] - dark) * std::pow(std::cos(angles[p]), exponent);
    for (int channel = 0; channel < 3; ++channel)
      most = std::max(most, std::abs(spot.values[p][channel] - (dark + colour[channel] * light)));
  }
  return most;
}

void show_spots(const std::filesystem::path& file, ClassicResult& result) {
  const std::vector<std::string> spot = {"effects.slide=false", "effects.spotlight=true",
                                         "patterns.kind=\"gray\"",
                                         "projector.spotlight={cutoff_deg=16, exponent=20}"};
  const ClassicDemo flashlight(file, spot);
  const glm::dvec3 colour(1, 0.45, 0.1);
  const Image<glm::vec3> coloured = in_colour(flashlight, colour);
  result.pictures.push_back(
      {"projected_light_spots",
       side_by_side({{"flashlight", shown(flashlight.core())}, {"coloured spot", colour_canvas(coloured, 1)}},
                    2)});
  const std::vector<double> angles = angles_rad(flashlight);
  double furthest = 0;
  for (const double angle : angles) furthest = std::fmax(furthest, glm::degrees(angle));
  const ClassicDemo open(file, {"effects.slide=false", "patterns.kind=\"gray\""});
  result.figures.insert(result.figures.end(),
                        {{"flashlight of 16°: widest lit angle", furthest, "deg", 0.01},
                         {"coloured spot to colour·cos²⁰θ of the open light, three channels, greatest",
                          distance_from_law(coloured, open, angles, colour, 20), "", 1e-6}});
}

double light_sum(const ClassicDemo& demo, const Image<double>& picture) {
  double sum = 0;
  for (std::size_t p = 0; p < picture.values.size(); ++p)
    if (demo.view.lights[0].lit(p)) sum += picture.values[p] * demo.full_lx - demo.scene.ambient_lx;
  return sum;
}

void show_intensity(const ClassicDemo& demo, const std::filesystem::path& file, ClassicResult& result) {
  const ClassicDemo brighter(file, {"projector.flux_lm=2800"});
  const Image<double> once = demo.core(), four = brighter.core();
  Image<double> four_shown = four;
  for (double& value : four_shown.values) value *= brighter.full_lx / demo.full_lx;
  result.pictures.push_back(
      {"projected_light_intensity",
       side_by_side({{"once", shown(once)}, {"4 times, clipped at white", shown(four_shown)}}, 2)});
  const auto clipped =
      std::ranges::count_if(four_shown.values, [](double value) { return value > 1 + 1e-6; });
  result.figures.insert(
      result.figures.end(),
      {{"light of × 4 over light", light_sum(brighter, four) / light_sum(demo, once), "", 1e-6},
       {"pixels that clip at × 4", double(clipped) / double(four.values.size()), "", 1e-3}});
}

}  // namespace

ClassicResult projected_light(const std::filesystem::path& scenes) {
  const std::filesystem::path file = scenes / "projected_light.toml";
  const ClassicDemo demo(file);
  ClassicResult result;
  result.pictures.push_back({"projected_light", shown(demo.core())});
  result.figures.push_back({"matrix by the stack to the core's (u, v), greatest",
                            demo.core_distance_px(stack_coordinates(demo)), "px", 1e-9});
  show_q_test(demo, result);
  show_border(demo, file, result);
  show_fov(file, result);
  show_spots(file, result);
  show_intensity(demo, file, result);
  return result;
}

}  // namespace laterna
