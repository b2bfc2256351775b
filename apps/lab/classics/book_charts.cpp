#include "apps/lab/classics/book_charts.h"

#include "apps/lab/classics/panels.h"
#include "apps/lab/classics/spot_passes.h"
#include "apps/lab/classics/vertex_light.h"
#include "sim/shapes.h"

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

/// A lit pixel of the first projector.
struct Sample {
  glm::dvec4 strq;
  glm::dvec3 x_world;
};

std::vector<Sample> lit_samples(const CoreView& view) {
  const auto strq = texture_coordinates(view.surface, view.scene, view.scene.cameras[0],
                                        view.scene.projectors[0], CoordinateSource::object_linear);
  const auto points = points_world(view.surface, view.scene);
  std::vector<Sample> samples;
  for (std::size_t p = 0; p < strq.values.size(); ++p)
    if (view.lights[0].lit(p)) samples.push_back({strq.values[p], points.values[p]});
  return samples;
}

template <class Error>
double rms_over(const std::vector<Sample>& samples, const Error& error) {
  double sum = 0;
  for (const Sample& sample : samples) sum += std::pow(error(sample), 2);
  return std::sqrt(sum / double(samples.size()));
}

double intensity_error(const std::vector<Sample>& samples, const Projector& projector, int n, Lookup lookup) {
  const Image<float> map = intensity_map(projector, n);
  return rms_over(samples, [&](const Sample& s) {
    const glm::dvec2 st = glm::dvec2(s.strq) / s.strq.w;
    return slide_value(map, s.strq, lookup, Wrap::clamp_to_edge) -
           cone_intensity(projector.effects.spotlight, slope_of(projector.device.intrinsics, st));
  });
}

// Those between the centres of the outermost texels of n³: beyond, a lookup is clamped.
std::vector<Sample> between_centres(const std::vector<Sample>& samples, int n) {
  std::vector<Sample> inside;
  std::ranges::copy_if(samples, std::back_inserter(inside), [&](const Sample& s) {
    const glm::dvec3 from_middle = glm::abs(glm::dvec3(s.strq) / s.strq.w - 0.5);
    return std::max({from_middle.x, from_middle.y, from_middle.z}) < 0.5 - 0.5 / n;
  });
  return inside;
}

double attenuation_error(const std::vector<Sample>& samples, const Projector& projector, int n,
                         DepthIndex index) {
  const AttenuationTexture texture = attenuation_texture(projector, glm::ivec3(n), index);
  const glm::dvec3 center = center_in_world(projector.device.device_from_world);
  return rms_over(samples, [&](const Sample& s) {
    return texture.value(glm::dvec3(s.strq) / s.strq.w) /
               attenuation_at(projector, glm::distance(center, s.x_world)) -
           1;
  });
}

Projector without_cutoff(Projector projector) {
  projector.effects.spotlight.cutoff_deg.reset();
  return projector;
}

/// The first object alone, a plane of n×n cells, and what the camera sees of it.
struct Floor {
  Scene scene;
  SurfaceMap surface;
  Floor(const Scene& whole, int n) : scene(whole) {
    const Box box = bounds(whole.objects[0].mesh);
    scene.objects = {whole.objects[0]};
    scene.objects[0].mesh = plane(box.high.x - box.low.x, box.high.y - box.low.y, n, n);
    surface = trace_surface(RayScene(scene), scene, scene.cameras[0]);
  }
};

double rms_share(const Image<float>& a, const Image<float>& exact, const SurfaceMap& surface) {
  double sum = 0;
  std::size_t seen = 0;
  for (std::size_t p = 0; p < a.values.size(); ++p)
    if (surface.hit(p)) ++seen, sum += std::pow(a.values[p] - exact.values[p], 2);
  return std::sqrt(sum / double(seen)) / std::ranges::max(exact.values);
}

std::string key_of(const char* what, int n) { return std::string(what) + " " + std::to_string(n); }

}  // namespace

void chart_intensity(const CoreView& view, ClassicResult& result) {
  const std::vector<Sample> samples = lit_samples(view);
  const Projector cone = view.scene.projectors[0], open = without_cutoff(cone);
  LineChart chart{
      "book_spotlight_intensity",
      "A spotlight's cone as a map of n x n texels",
      "n",
      "rms error, share of the peak",
      {{"bilinear, with the cutoff", {}}, {"bilinear, exponent alone", {}}, {"nearest, exponent alone", {}}}};
  for (int n = 8; n <= 1024; n *= 2) {
    chart.series[0].points.emplace_back(n, intensity_error(samples, cone, n, Lookup::bilinear));
    chart.series[1].points.emplace_back(n, intensity_error(samples, open, n, Lookup::bilinear));
    chart.series[2].points.emplace_back(n, intensity_error(samples, open, n, Lookup::nearest));
  }
  for (auto& series : chart.series) series.tolerance = 0.1;
  result.charts.push_back(std::move(chart));
}

void chart_attenuation(const CoreView& view, ClassicResult& result) {
  const std::vector<Sample> samples = lit_samples(view);
  const Projector& projector = view.scene.projectors[0];
  LineChart chart{
      "book_spotlight_attenuation",
      "Attenuation by a 3D texture of n x n x n texels",
      "n",
      "rms of the ratio to exact 1/d², - 1",
      {{"r/q hyperbolic", {}}, {"the same, 1/16 off the ends", {}, 0.05}, {"r/q read as linear", {}}}};
  constexpr int coarse = 8;
  const std::vector<Sample> inside = between_centres(samples, coarse);
  for (int n = 4; n <= 128; n *= 2) {
    const auto error = [&](const std::vector<Sample>& over, DepthIndex index) {
      return attenuation_error(over, projector, n, index);
    };
    chart.series[0].points.emplace_back(n, error(samples, DepthIndex::hyperbolic));
    if (n >= coarse) chart.series[1].points.emplace_back(n, error(inside, DepthIndex::hyperbolic));
    chart.series[2].points.emplace_back(n, error(samples, DepthIndex::linear));
  }
  constexpr std::size_t at_64 = 4;
  for (const auto& [series, name] : {std::pair(0, "r/q hyperbolic"), std::pair(2, "r/q read as linear")})
    result.figures.push_back(
        {std::string("attenuation texture of 64 x 64 x 64, ") + name + ", rms of ratio - 1",
         chart.series[std::size_t(series)].points[at_64].second, "", 1e-3});
  result.charts.push_back(std::move(chart));
}

void chart_vertices(const CoreView& view, ClassicResult& result) {
  const Projector cone = view.scene.projectors[0], open = without_cutoff(cone);
  const auto light_of = [](const Projector& projector) {
    return [&projector](const glm::dvec3& x) { return spot_at(projector, x); };
  };
  LineChart chart{"book_spotlight_vertices",
                  "Light per vertex: a floor of n x n cells",
                  "n",
                  "rms error, share of the peak",
                  {{"with the cutoff", {}, 0.05}, {"exponent alone", {}, 0.05}}};
  std::vector<Panel> panels;
  for (int n = 2; n <= 256; n *= 2) {
    const Floor floor(view.scene, n);
    const Image<float> exact = sample_light(floor.surface, floor.scene, light_of(cone));
    const Image<float> coarse = vertex_light(floor.surface, floor.scene, light_of(cone));
    chart.series[0].points.emplace_back(n, rms_share(coarse, exact, floor.surface));
    chart.series[1].points.emplace_back(
        n, rms_share(vertex_light(floor.surface, floor.scene, light_of(open)),
                     sample_light(floor.surface, floor.scene, light_of(open)), floor.surface));
    const double white = std::ranges::max(exact.values);
    if (n == 4 || n == 16 || n == 64)
      panels.push_back({key_of("per vertex, cells each way:", n), grey_canvas(coarse, white)});
    if (n == 64) panels.push_back({"per sample", grey_canvas(exact, white)});
  }
  result.pictures.push_back({"book_spotlight_vertices", side_by_side(panels, 2)});
  for (const auto& [at, n] : {std::pair(1, 4), std::pair(3, 16), std::pair(5, 64)})
    result.figures.push_back({key_of("light per vertex, rms share of peak, cells each way:", n),
                              chart.series[0].points[std::size_t(at)].second, "", 1e-3});
  result.charts.push_back(std::move(chart));
}

}  // namespace laterna
