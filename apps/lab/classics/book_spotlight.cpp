#include "apps/lab/classics/book_spotlight.h"

#include "apps/lab/classics/book_charts.h"
#include "apps/lab/classics/demo.h"
#include "apps/lab/classics/spot_passes.h"
#include "sim/scene_file.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

/// The book's scene; the frame buffer's 1 is the light of a point on a projector's axis at 1 m.
struct Book {
  Scene scene;
  CoreView view;
  Fragments fragments;
  double light_lx, white;  ///< of 1: illuminance, and luminance in cd/m² of the plain albedo

  explicit Book(const std::filesystem::path& file, const std::vector<std::string>& set = {})
      : scene(load_scene(file, set)), view(scene), fragments(scene) {
    const Intrinsics& k = scene.projectors[0].device.intrinsics;
    light_lx = scene.projectors[0].flux_lm / (double(k.size.x) * k.size.y) * k.fx * k.fy;
    white = scene.objects[0].albedo * light_lx / std::numbers::pi;
  }
  std::vector<Image<double>> passes(const SpotOptions& options, std::vector<int> which = {0, 1}) const {
    PassOptions pass{.ambient = scene.ambient_lx / light_lx, .depth_again = false};
    for (const int k : which)
      pass.lights.push_back(spot_shade(fragments, scene.projectors[std::size_t(k)], options));
    return draw_passes(fragments, pass);
  }
  Image<double> core() const {
    const Image<float> picture = core_picture(view);
    Image<double> shares(picture.width, picture.height);
    std::transform(picture.values.begin(), picture.values.end(), shares.values.begin(),
                   [&](float value) { return value / white; });
    return shares;
  }
};

constexpr SpotOptions exact{.map_texels = 0, .volume_texels = 0};

double peak(const Image<double>& image) { return std::ranges::max(image.values); }

void show_passes(const Book& book, ClassicResult& result) {
  const auto by_texture = book.passes({}), by_law = book.passes(exact);
  const Image<double> core = book.core();
  const double white = peak(by_law[1]);
  result.pictures.push_back({"book_spotlight", shown(core, peak(core))});
  result.pictures.push_back(
      {"book_spotlight_passes", side_by_side({{"1: ambient + depth", shown(by_texture[0], white)},
                                              {"2: each light added", shown(by_texture[1], white)},
                                              {"3: times the surface's texture", shown(by_texture[2], white)},
                                              {"the core, one pass", shown(core, white)}},
                                             2)});
  result.figures.insert(result.figures.end(), {{"three passes by the law to one, greatest share of peak",
                                                greatest_difference(by_law[2], core) / peak(core), "", 1e-6},
                                               {"three passes by textures to one, rms share of peak",
                                                rms_difference(by_texture[2], core) / peak(core), "", 1e-3}});
}

void show_lights(const Book& book, ClassicResult& result) {
  const auto both = book.passes(exact)[1], left = book.passes(exact, {0})[1],
             right = book.passes(exact, {1})[1];
  Image<double> sum = left;
  for (std::size_t p = 0; p < sum.values.size(); ++p)
    sum.values[p] += right.values[p] - (both.values[p] > 0 ? book.scene.ambient_lx / book.light_lx : 0);
  const double white = peak(both);
  result.pictures.push_back(
      {"book_spotlight_lights",
       side_by_side(
           {{"left", shown(left, white)}, {"right", shown(right, white)}, {"both", shown(both, white)}}, 3)});
  result.figures.push_back({"several lights: both to the sum of each, greatest",
                            greatest_difference(both, sum) / white, "", 1e-9});
}

// Pixels with one light's texture, counted by how far outside its picture they lie.
struct Leak {
  double anywhere = 0, beyond_half_a_texel = 0;
};
Leak leak(const Book& book, const Image<double>& picture, int map_texels) {
  const double dark = book.scene.ambient_lx / book.light_lx;
  const auto strq = texture_coordinates(book.view.surface, book.scene, book.scene.cameras[0],
                                        book.scene.projectors[0], CoordinateSource::object_linear);
  Leak found;
  for (std::size_t p = 0; p < picture.values.size(); ++p) {
    if (!(picture.values[p] > dark + 1e-9)) continue;
    const glm::dvec2 from_middle = glm::abs(glm::dvec2(strq.values[p]) / strq.values[p].w - 0.5);
    const double outside_texels = map_texels * (std::max(from_middle.x, from_middle.y) - 0.5);
    found.anywhere += outside_texels > 1e-9;
    found.beyond_half_a_texel += outside_texels > 0.5 + 1e-9;
  }
  found.anywhere /= double(picture.values.size()), found.beyond_half_a_texel /= double(picture.values.size());
  return found;
}

// A cone wider than the picture, in a map so coarse that half a texel can be seen.
void show_border(const std::filesystem::path& file, ClassicResult& result) {
  const Book book(file, {"projector.0.spotlight.cutoff_deg=60.0", "projector.0.spotlight.exponent=2.0"});
  constexpr int texels = 16;
  const FragmentTests front{.q = true, .st = false, .r = false};
  const auto draw_with = [&](const FragmentTests& tests, Wrap wrap) {
    return book.passes({.map_texels = texels, .volume_texels = 0, .tests = tests, .wrap = wrap}, {0})[1];
  };
  const auto clamped = draw_with(front, Wrap::clamp_to_edge), border = draw_with(front, Wrap::border);
  const auto killed = draw_with({}, Wrap::clamp_to_edge);
  const double white = peak(killed);
  result.pictures.push_back(
      {"book_spotlight_border", side_by_side({{"clamp-to-edge: smears", shown(clamped, white)},
                                              {"border texel: fades", shown(border, white)},
                                              {"killed outside: ends", shown(killed, white)}},
                                             3)});
  result.figures.insert(
      result.figures.end(),
      {{"clamp-to-edge: pixels with light outside the picture", leak(book, clamped, texels).anywhere, "",
        1e-3},
       {"border texel: pixels with light outside the picture", leak(book, border, texels).anywhere, "", 1e-3},
       {"border texel: of them beyond half a texel", leak(book, border, texels).beyond_half_a_texel, "", 0},
       {"killed: pixels with light outside the picture", leak(book, killed, texels).anywhere, "", 0}});
}

void show_attenuation(const Book& book, ClassicResult& result) {
  const auto picture = [&](SpotOptions options) {
    options.map_texels = 0;
    return book.passes(options, {0})[1];
  };
  const auto law = picture({.volume_texels = 0}), right = picture({.volume_texels = 32}),
             naive = picture({.volume_texels = 32, .index = DepthIndex::linear});
  const double white = peak(law);
  result.pictures.push_back(
      {"book_spotlight_attenuation", side_by_side({{"exact 1/d^2", shown(law, white)},
                                                   {"3D texture, r/q hyperbolic", shown(right, white)},
                                                   {"3D texture, r/q read as linear", shown(naive, white)}},
                                                  3)});
}

}  // namespace

ClassicResult book_spotlight(const std::filesystem::path& scenes) {
  const std::filesystem::path file = scenes / "book_spotlight.toml";
  const Book book(file);
  ClassicResult result;
  show_passes(book, result);
  show_lights(book, result);
  show_border(file, result);
  show_attenuation(book, result);
  chart_intensity(book.view, result);
  chart_attenuation(book.view, result);
  chart_vertices(book.view, result);
  return result;
}

}  // namespace laterna
