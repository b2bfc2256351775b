#include "apps/lab/classics/slide_projector.h"

#include "apps/lab/classics/demo.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

using Demo = ClassicDemo;

// How far two ways to (s, t, r, q) lie apart, in projector pixels, where the point is before the projector.
Image<float> distance_px(const Demo& demo, CoordinateSource a, CoordinateSource b) {
  const auto one = demo.coordinates(a), other = demo.coordinates(b);
  const glm::ivec2 size = demo.projector().device.intrinsics.size;
  Image<float> distance(one.width, one.height, NAN);
  for (std::size_t p = 0; p < distance.values.size(); ++p)
    if (one.values[p].w > 0)
      distance.values[p] = float(
          glm::distance(pixel_from_texture(one.values[p], size), pixel_from_texture(other.values[p], size)));
  return distance;
}

double greatest(const Image<float>& image) {
  double most = 0;
  for (const float value : image.values)
    if (std::isfinite(value)) most = std::max(most, double(value));
  return most;
}

void show_coordinates(const Demo& demo, ClassicResult& result) {
  using enum CoordinateSource;
  const auto picture = [&](CoordinateSource source) { return demo.passes({.coordinates = source}).back(); };
  const Image<double> object = picture(object_linear), eye = picture(eye_linear), caller = picture(given);
  Image<double> apart(object.width, object.height);
  for (std::size_t p = 0; p < apart.values.size(); ++p)
    apart.values[p] =
        std::abs(object.values[p] - eye.values[p]) + std::abs(object.values[p] - caller.values[p]);
  result.pictures.push_back(
      {"slide_projector_coordinates", side_by_side({{"object-linear", shown(object)},
                                                    {"eye-linear", shown(eye)},
                                                    {"given per vertex", shown(caller)},
                                                    {"their differences", shown(apart)}},
                                                   2)});
  const double rounding_px = 1e-9;
  result.figures.insert(
      result.figures.end(),
      {{"object-linear to eye-linear, greatest", greatest(distance_px(demo, object_linear, eye_linear)), "px",
        rounding_px},
       {"object-linear to given, greatest", greatest(distance_px(demo, object_linear, given)), "px",
        rounding_px},
       {"object-linear to the core's (u, v), greatest",
        demo.core_distance_px(demo.coordinates(object_linear)), "px", rounding_px},
       {"object-linear and eye-linear: pixels that differ", share_that_differs(object, eye), "", 1e-4},
       {"object-linear and given: pixels that differ", share_that_differs(object, caller), "", 1e-4}});
}

void show_passes(const Demo& demo, ClassicResult& result) {
  const auto exact = demo.passes({}), bits = demo.passes({}, 255);
  const Image<double> core = demo.core();
  result.pictures.push_back({"slide_projector", shown(core)});
  result.pictures.push_back(
      {"slide_projector_passes", side_by_side({{"1: ambient + depth", shown(exact[0])},
                                               {"2: light where depth is equal", shown(exact[1])},
                                               {"3: depth again", shown(exact[2])},
                                               {"4: times the surface's texture", shown(exact[3])}},
                                              2)});
  result.figures.insert(
      result.figures.end(),
      {{"four passes to one, greatest share of white", greatest_difference(exact[3], core), "", 1e-6},
       {"four passes of 8 bits to one, greatest", 255 * greatest_difference(bits[3], core), "DN", 0.01}});
}

void show_kill(const Demo& demo, ClassicResult& result) {
  const FragmentTests none{.q = true, .st = false, .r = false};
  const auto kept = demo.passes({.tests = none, .wrap = Wrap::repeat}).back();
  const auto killed = demo.passes({.wrap = Wrap::repeat}).back();
  result.pictures.push_back(
      {"slide_projector_kill", side_by_side({{"nothing killed: the slide repeats", shown(kept)},
                                             {"killed outside [0, 1]", shown(killed)}},
                                            2)});
  result.figures.push_back(
      {"pixels with light that the kill takes away", share_that_differs(kept, killed), "", 1e-3});
}

// Pixels whose r/q test and whose depth, by the core, say different things.
std::size_t planes_that_disagree(const Demo& demo) {
  const auto strq = demo.coordinates(CoordinateSource::object_linear);
  const LightMap& light = demo.view.lights[0];
  std::size_t count = 0;
  for (std::size_t p = 0; p < strq.values.size(); ++p) {
    if (!demo.view.surface.hit(p)) continue;
    const auto why = Unlit(light.why.values[p]);
    const bool beyond = why == Unlit::before_near || why == Unlit::beyond_far;
    count += beyond == survives(strq.values[p], {.q = true, .st = false, .r = true});
  }
  return count;
}

// The same room with the light between two planes that cross it.
void show_planes(const std::filesystem::path& file, ClassicResult& result) {
  const Demo demo(file, {"projector.near=3.4", "projector.far=4.9"});
  const auto strq = demo.coordinates(CoordinateSource::object_linear);
  Image<float> r(strq.width, strq.height);
  std::transform(strq.values.begin(), strq.values.end(), r.values.begin(),
                 [](const glm::dvec4& at) { return float(at.z / at.w); });
  const auto picture = demo.passes({}).back();
  result.pictures.push_back(
      {"slide_projector_planes",
       side_by_side({{"light between two planes", shown(picture)}, {"r/q, 0 to 1", map_canvas(r, 0, 1)}},
                    2)});
  result.figures.insert(result.figures.end(), {{"light planes: pixels where r/q and depth disagree",
                                                double(planes_that_disagree(demo)), "", 0},
                                               {"light planes: four passes to one, greatest share of white",
                                                greatest_difference(picture, demo.core()), "", 1e-6}});
}

// Pixels that show the slide on a face that is turned away from the projector.
double share_turned_away(const Demo& demo, const Image<double>& picture, const Image<double>& dark) {
  std::size_t count = 0;
  for (const auto& object : demo.fragments.objects)
    for (std::size_t p = 0; p < picture.values.size(); ++p)
      count += object.surface.hit(p) &&
               object.surface.depth_m.values[p] == demo.view.surface.depth_m.values[p] &&
               !faces(object, p, demo.projector()) && picture.values[p] > dark.values[p] + 1e-6;
  return double(count) / double(picture.values.size());
}

void show_turned_away(const Demo& demo, const std::filesystem::path& file, ClassicResult& result) {
  const auto off = demo.passes({.back_face = false}).back(), on = demo.passes({}).back();
  const Demo core_off(file, {"effects.back_face=false"});
  Image<double> dark = demo.passes({.tests = {}, .back_face = true}).front();
  for (std::size_t p = 0; p < dark.values.size(); ++p)
    dark.values[p] *= demo.view.surface.albedo.values[p] / demo.scene.objects[0].albedo;
  result.pictures.push_back(
      {"slide_projector_turned_away",
       side_by_side({{"back-face test off", shown(off)}, {"back-face test on", shown(on)}}, 2)});
  result.figures.insert(
      result.figures.end(),
      {{"light on faces turned away, test off", share_turned_away(demo, off, dark), "", 1e-3},
       {"light on faces turned away, test on", share_turned_away(demo, on, dark), "", 0},
       {"test off: four passes to the core's `back_face = false`, greatest",
        greatest_difference(off, core_off.core()), "", 1e-6}});
}

}  // namespace

ClassicResult slide_projector(const std::filesystem::path& scenes) {
  const std::filesystem::path file = scenes / "slide_projector.toml";
  const Demo demo(file);
  ClassicResult result;
  show_passes(demo, result);
  show_coordinates(demo, result);
  show_kill(demo, result);
  show_planes(file, result);
  show_turned_away(demo, file, result);
  return result;
}

}  // namespace laterna
