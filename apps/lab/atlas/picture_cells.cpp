#include "apps/lab/atlas/cell_kinds.h"
#include "apps/lab/noun_json.h"
#include "apps/lab/report/thumbnails.h"
#include "apps/lab/trial.h"
#include "render/effects/apply_effects.h"
#include "sim/scene_file.h"
#include "sim/self_contained.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

namespace laterna {

namespace {

/// A scene with some keys set to other values. Beside these fields a condition may have scene keys with a
/// dot, as "camera.samples_per_pixel" = [1, 4]: overrides after those of `set`.
struct PictureCondition {
  std::string scene;             ///< file, relative to the specification
  std::vector<std::string> set;  ///< overrides as parse_scene() takes them
};

template <class Visitor>
void describe(Visitor& visit, PictureCondition& c) {
  visit(Field{.key = "scene"}, c.scene);
  visit(Field{.key = "set"}, c.set);
}

PictureCondition condition_of(const nlohmann::json& values, const std::string& place) {
  nlohmann::json fields = nlohmann::json::object();
  std::vector<std::string> overrides;
  for (const auto& [key, value] : values.items()) {
    if (key.find('.') == std::string::npos)
      fields[key] = value;
    else
      overrides.push_back(key + "=" + value.dump());  // a JSON scalar or list is a TOML one
  }
  auto condition = noun_from_json<PictureCondition>(fields, place);
  condition.set.insert(condition.set.end(), overrides.begin(), overrides.end());
  return condition;
}

// How far the light lands from where it should, across the ray: at axial depth z a projector pixel is z/f
// wide.
double surface_rms_mm(const Device& truth, const Device& estimate, std::span<const glm::dvec3> points) {
  const std::vector<glm::dvec2> errors = error_vectors(truth, estimate, points);
  double sum = 0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double z = apply(truth.device_from_world, points[k]).z;
    const glm::dvec2 d = 1e3 * z * errors[k] / glm::dvec2(truth.intrinsics.fx, truth.intrinsics.fy);
    sum += glm::dot(d, d);
  }
  return points.empty() ? NAN : std::sqrt(sum / double(points.size()));
}

CellAnswer answer_of(const Scene& scene, const Traced& traced, const ProjectorOutcome& outcome) {
  CellAnswer answer;
  answer.status = outcome.solve.status, answer.reason = outcome.solve.reason;
  if (outcome.solve.status == Status::refused) return answer;
  answer.error_px = outcome.verification.volume.rms;
  answer.error_mm = surface_rms_mm(scene.projectors[std::size_t(outcome.projector)].device,
                                   outcome.solve.estimate, lit_points(traced, outcome.projector));
  answer.predicted_px = outcome.solve.predicted_volume_rms_px;
  answer.independent_px = outcome.solve.predicted_volume_rms_independent_px;
  if (!outcome.flags.empty())
    answer.reason +=
        fmt::format("{}flags: {}", answer.reason.empty() ? "" : "; ", fmt::join(outcome.flags, "; "));
  return answer;
}

Outcome fared(const CellAnswer& answer) {
  return grade(answer.status, answer.error_px, answer.predicted_px.value_or(NAN));
}

// The projector that fares worst counts, the first of several.
CellAnswer round_trip(const Scene& scene, std::uint64_t seed) {
  StageTimes times;
  TrialOptions options;
  options.seed = options.solve.seed = seed;
  const Traced traced = trace(scene, times);
  std::optional<CellAnswer> worst;
  for (const ProjectorOutcome& outcome : run_trial(scene, traced, options, times)) {
    CellAnswer answer = answer_of(scene, traced, outcome);
    if (!worst || fared(answer) > fared(*worst)) worst = std::move(answer);
  }
  std::erase_if(times.stages, [](const auto& stage) { return stage.name == "verify"; });
  worst->times = std::move(times);
  for (const Projector& projector : scene.projectors)  // one after the other; all cameras at once
    worst->pictures += picture_count(pattern_sequence(scene, projector));
  return *worst;
}

Image<glm::u8vec3> beside(const Image<std::uint8_t>& left, const Image<glm::u8vec3>& right) {
  Image<glm::u8vec3> both(left.width + right.width, std::max(left.height, right.height));
  for (int y = 0; y < left.height; ++y)
    for (int x = 0; x < left.width; ++x) both(x, y) = glm::u8vec3(left(x, y));
  for (int y = 0; y < right.height; ++y)
    for (int x = 0; x < right.width; ++x) both(left.width + x, y) = right(x, y);
  return both;
}

// The round trip once more, for the first view's pictures.
Image<glm::u8vec3> picture_of(const Scene& scene, std::uint64_t seed) {
  StageTimes times;
  TrialOptions options;
  options.seed = options.solve.seed = seed;
  const Traced traced = trace(scene, times);
  Image<glm::u8vec3> picture;
  const auto keep = [&](const View& view, const CapturedStack* pictures, const DecodedMap& decoded) {
    if (&view != &traced.views.front() || !pictures) return;
    const Projector& projector = scene.projectors[std::size_t(view.projector)];
    const int full_scale = (1 << scene.cameras[std::size_t(view.camera)].sensor.bit_depth) - 1;
    const std::vector<Image<std::uint8_t>> small = thumbnails(*pictures, full_scale);
    picture = beside(small[std::size_t(white_picture(pattern_sequence(scene, projector)))],
                     map_picture(decoded.u_px, 0, projector.device.intrinsics.size.x - 1, 384));
  };
  run_trial(scene, traced, options, times, keep);
  return picture;
}

}  // namespace

CellKind picture_cells() {
  return {"pictures",
          {"laterna"},
          [](const nlohmann::json& values, const std::string& place, const std::filesystem::path& folder) {
            const PictureCondition condition = condition_of(values, place);
            try {
              const auto scene =
                  std::make_shared<const Scene>(load_scene(folder / condition.scene, condition.set));
              return CellTrial([scene](std::uint64_t seed) {
                return CellProblem{[scene, seed](const std::string&) { return round_trip(*scene, seed); },
                                   [] { return double(NAN); },
                                   [scene, seed] { return picture_of(*scene, seed); }};
              });
            } catch (const InputError& error) {
              throw InputError(fmt::format("{}: {}", place, error.what()));
            }
          },
          [](const nlohmann::json& values, const std::string& place, const std::filesystem::path& folder) {
            const PictureCondition condition = condition_of(values, place);
            const std::filesystem::path file = folder / condition.scene;
            auto files = files_of(read_scene_spec(file, condition.set), file.parent_path());
            files.insert(files.begin(), file);
            return files;
          }};
}

}  // namespace laterna
