#include "apps/lab/report/capture_figures.h"

#include "apps/lab/decode_folder.h"
#include "apps/lab/percentile.h"
#include "apps/lab/report/thumbnails.h"
#include "apps/lab/report/trial_figures.h"
#include "apps/lab/trial_report.h"
#include "sim/error.h"
#include "sim/image_file.h"
#include "sim/plain_name.h"
#include "sim/scene_file.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace laterna {

using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

Json map_figure(const char* label, const Image<double>& map, double high, const char* unit) {
  return {{"label", label},
          {"low", 0},
          {"high", high},
          {"unit", unit},
          {"image", data_uri(map_picture(map, 0, std::max(high, 1e-12)))}};
}

const Image<float>& plane(const ExrLayers& layers, const std::string& name, const fs::path& file) {
  for (std::size_t k = 0; k < layers.names.size(); ++k)
    if (layers.names[k] == name) return layers.planes[k];
  throw InputError(fmt::format("{}: has no layer \"{}\"", file.string(), name));
}

DecodedMap read_decoded(const fs::path& file) {
  const ExrLayers layers = read_exr_layers(file);
  const Image<float>&u = plane(layers, "projector.u", file), &v = plane(layers, "projector.v", file);
  DecodedMap map(u.width, u.height);
  std::copy(u.values.begin(), u.values.end(), map.u_px.values.begin());
  std::copy(v.values.begin(), v.values.end(), map.v_px.values.begin());
  map.sigma_px = plane(layers, "sigma.px", file);
  const Image<float>& valid = plane(layers, "valid", file);
  for (std::size_t i = 0; i < valid.values.size(); ++i) map.valid.values[i] = valid.values[i] > 0;
  return map;
}

fs::path inside(const fs::path& folder, const Json& name) {
  check_inner_path(name.get<std::string>(), (folder / "figures.json").string());
  return folder / name.get<std::string>();
}

Json frames_of(const CapturedStack& stack, const CaptureSequence& sequence) {
  const std::vector<Image<std::uint8_t>> small = thumbnails(stack, (1 << sequence.bit_depth) - 1);
  const std::vector<std::string> labels =
      frame_labels({sequence.patterns, sequence.projector_size}, int(small.size()));
  Json frames = Json::array();
  for (std::size_t k = 0; k < small.size(); ++k)
    frames.push_back({{"label", labels[k]}, {"image", data_uri(small[k])}});
  return frames;
}

// What the pixels of a view truly see.
PixelArray<glm::dvec3> true_points(const fs::path& file) {
  const ExrLayers layers = read_exr_layers(file);
  const Image<float>&x = plane(layers, "world.x", file), &y = plane(layers, "world.y", file),
        &z = plane(layers, "world.z", file);
  PixelArray<glm::dvec3> points(x.width, x.height);
  for (std::size_t i = 0; i < x.values.size(); ++i)
    points.values[i] = {x.values[i], y.values[i], z.values[i]};
  return points;
}

const StoredEstimate* estimate_of(const std::vector<StoredEstimate>& estimates, const std::string& name) {
  for (const StoredEstimate& e : estimates)
    if (e.device.name == name) return &e;
  return nullptr;
}

// Everything about one sequence; maps only where its pictures tell places.
void add_sequence(const fs::path& folder, const CaptureSequence& sequence, const Scene* scene,
                  const std::vector<StoredEstimate>& estimates, Json& data) {
  const CapturedStack pictures = read_pictures(folder, sequence);
  Json view{{"camera", sequence.camera},
            {"projector", sequence.projector},
            {"frames", frames_of(pictures, sequence)},
            {"maps", Json::array()}};
  const StoredEstimate* estimate = estimate_of(estimates, sequence.projector);
  if (is_coded(sequence.patterns.kind)) {
    const DecodedSequence decoded = decode_sequence(folder, sequence, pictures, {});
    view["maps"] = map_figures(decoded.map, sequence.projector_size);
    view["valid_percent"] = valid_percent(decoded.map);
    if (scene && !sequence.truth.empty()) {
      const PixelArray<glm::dvec3> points = true_points(folder / sequence.truth);
      std::vector<glm::dvec3> lit;
      for (std::size_t i = 0; i < points.values.size(); ++i)
        if (decoded.map.valid.values[i] && std::isfinite(points.values[i].x)) lit.push_back(points.values[i]);
      data["figures"]["points"] = points_figure(lit);
      for (const Projector& p : scene->projectors) {
        if (!estimate || p.device.name != sequence.projector || lit.empty()) continue;
        data["figures"]["residuals"].push_back(
            residual_figure(decoded.map, points, estimate->device, sequence.camera, sequence.projector));
        data["figures"]["projections"].push_back(
            projection_figure(p.device, estimate->device, estimate->covariance, lit));
      }
    }
  }
  data["views"].push_back(std::move(view));
}

Json empty_figures(const Scene& scene) {
  return {{"rig", rig_figure(scene)},
          {"points", Json::array()},
          {"residuals", Json::array()},
          {"projections", Json::array()}};
}

}  // namespace

Json map_figures(const DecodedMap& map, glm::ivec2 projector_size) {
  Image<double> sigma(map.width, map.height);
  std::copy(map.sigma_px.values.begin(), map.sigma_px.values.end(), sigma.values.begin());
  return {map_figure("projector column", map.u_px, projector_size.x - 1, "px"),
          map_figure("projector row", map.v_px, projector_size.y - 1, "px"),
          map_figure("standard deviation", sigma, percentile_99(map.sigma_px), "px")};
}

Json stored_view(const fs::path& folder, const Json& view) {
  const DecodedMap map = read_decoded(inside(folder, view.at("decoded")));
  const auto size = view.at("projector_size").get<std::array<int, 2>>();
  Json frames = Json::array();
  for (const Json& frame : view.at("frames"))
    frames.push_back(
        {{"label", frame.at("label")}, {"image", data_uri_of_file(inside(folder, frame.at("file")))}});
  return {{"camera", view.at("camera")},
          {"projector", view.at("projector")},
          {"frames", std::move(frames)},
          {"maps", map_figures(map, {size[0], size[1]})},
          {"valid_percent", valid_percent(map)}};
}

void add_capture(const fs::path& folder, Json& data) {
  const CaptureManifest manifest = read_manifest(folder);
  std::optional<Scene> scene;
  if (!manifest.scene.empty()) scene = load_scene(folder / manifest.scene);
  if (scene && !data.contains("figures")) data["figures"] = empty_figures(*scene);
  std::vector<StoredEstimate> estimates;
  const fs::path stored = folder / "estimate.json";
  if (fs::exists(stored)) {
    estimates = read_estimates(stored);
    data["estimate"] = Json::parse(read_text(stored, std::size_t(64) << 20));
  }
  for (const CaptureSequence& sequence : manifest.sequences)
    add_sequence(folder, sequence, scene ? &*scene : nullptr, estimates, data);
}

}  // namespace laterna
