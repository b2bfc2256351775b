#include "apps/lab/trial.h"

#include "render/effects/apply_effects.h"
#include "sim/error.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace laterna {

namespace {

constexpr float nan_f = std::numeric_limits<float>::quiet_NaN();

// Where the selected pixels of each image row stand in a list of all of them that goes on from `first`; one
// more says where it ends.
template <class Selected>
std::vector<std::size_t> row_begins(int width, int height, std::size_t first, const Selected& selected) {
  std::vector<std::size_t> begin(std::size_t(height) + 1, 0);
  parallel_for(height, [&](std::size_t y) {
    std::size_t count = 0;
    for (std::size_t i = y * width; i < (y + 1) * width; ++i) count += selected(i);
    begin[y + 1] = count;
  });
  begin[0] = first;
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  return begin;
}

// Calls take(pixel's index, place in the list) for each of them.
template <class Selected, class Take>
void for_selected(int width, const std::vector<std::size_t>& begin, const Selected& selected,
                  const Take& take) {
  parallel_for(begin.size() - 1, [&](std::size_t y) {
    std::size_t k = begin[y];
    for (std::size_t i = y * width; i < (y + 1) * width; ++i)
      if (selected(i)) take(i, k++);
  });
}

void judge(const Scene& scene, const Traced& traced, const Correspondences& correspondences,
           const TrialOptions& options, ProjectorOutcome& outcome) {
  const Device& truth = scene.projectors[outcome.projector].device;
  if (correspondences.world_points.empty()) {
    outcome.solve.status = Status::refused;
    outcome.solve.reason = "no overlap: no camera pixel sees light of this projector that could be decoded";
    return;
  }
  SolveOptions solve_options = options.solve;
  solve_options.lens_model = truth.lens.model;
  if (options.known_intrinsics) solve_options.known = KnownIntrinsics{truth.intrinsics, truth.lens};
  solve_options.seed = options.seed;
  outcome.solve = outcome.times.measure(
      "solve", [&] { return solve(correspondences, truth.intrinsics.size, solve_options); });
  if (outcome.solve.status == Status::refused) return;
  const LargeVector<glm::dvec3> points = lit_points(traced, outcome.projector);
  if (points.empty()) {
    outcome.solve.status = Status::refused;
    outcome.solve.reason = "pictures decoded although no camera pixel is lit: noise was taken for signal";
    return;
  }
  outcome.times.measure("verify", [&] {
    outcome.verification = verify(truth, outcome.solve.estimate, outcome.solve.covariance, points);
    const double predicted = outcome.verification.volume.predicted_rms;
    if (outcome.solve.status == Status::ok && !(predicted <= solve_options.tolerance_px)) {
      outcome.solve.status = Status::weak;
      outcome.solve.reason =
          fmt::format("{} predicts {:.3g} px over the volume, above the tolerance of {:.3g} px",
                      outcome.solve.covariance_camera.empty() ? "noise" : "noise and uncertain cameras",
                      predicted, solve_options.tolerance_px);
    }
    outcome.surface_error_px.reserve(points.size());
    for (const glm::dvec2& e : error_vectors(truth, outcome.solve.estimate, points)) {
      outcome.surface_error_px.push_back(float(glm::length(e)));
    }
  });
}

void append_flags(const CapturedStack& pictures, const PatternSequence& sequence, const DecodedMap& map,
                  ProjectorOutcome& outcome) {
  outcome.times.measure("decode", [&] {
    const DecodeReport report = report_on(pictures, sequence, map);
    outcome.flags.insert(outcome.flags.end(), report.flags.begin(), report.flags.end());
    outcome.doubts.insert(outcome.doubts.end(), report.doubts.begin(), report.doubts.end());
  });
}

}  // namespace

LargeVector<glm::dvec3> lit_points(const Traced& traced, int projector) {
  LargeVector<glm::dvec3> points;
  for (const View& view : traced.views) {
    if (view.projector != projector) continue;
    const PixelArray<glm::dvec3>& points_world = traced.points_world[view.camera];
    const auto lit = [&](std::size_t i) { return view.light.lit(i); };
    const auto begin = row_begins(points_world.width, points_world.height, points.size(), lit);
    points.resize(begin.back());
    for_selected(points_world.width, begin, lit,
                 [&](std::size_t i, std::size_t k) { points[k] = points_world.values[i]; });
  }
  return points;
}

void append_correspondences(const DecodedMap& decoded, const ToldPoints& told, int camera, int block_px,
                            Correspondences& out) {
  const PixelArray<glm::dvec3>& points_world = told.points_world;
  const int width = points_world.width, height = points_world.height;
  const std::uint32_t columns = std::uint32_t((width + block_px - 1) / block_px);
  const std::uint32_t blocks = columns * std::uint32_t((height + block_px - 1) / block_px);
  const auto usable = [&](std::size_t i) {
    return decoded.valid.values[i] && !std::isnan(points_world.values[i].x);
  };
  const auto begin = row_begins(width, height, out.world_points.size(), usable);
  out.world_points.resize(begin.back()), out.projector_pixels.resize(begin.back());
  out.sigma_px.resize(begin.back()), out.cluster.resize(begin.back());
  if (!out.cameras.empty()) {
    out.camera.resize(begin.back(), std::uint32_t(camera));
    out.normals_world.resize(begin.back());
  }
  for_selected(width, begin, usable, [&](std::size_t i, std::size_t k) {
    const std::uint32_t x = std::uint32_t(i % std::size_t(width)), y = std::uint32_t(i / std::size_t(width));
    out.world_points[k] = points_world.values[i];
    out.projector_pixels[k] = {decoded.u_px.values[i], decoded.v_px.values[i]};
    out.sigma_px[k] = decoded.sigma_px.values[i];
    if (!out.cameras.empty()) out.normals_world[k] = told.normals_world.values[i];
    out.cluster[k] =
        std::uint32_t(camera) * blocks + y / std::uint32_t(block_px) * columns + x / std::uint32_t(block_px);
  });
}

DecodedMap true_map(const LightMap& light) {
  DecodedMap map(light.width, light.height);
  for (std::size_t i = 0; i < map.valid.values.size(); ++i) {
    const bool lit = light.lit(i);
    map.u_px.values[i] = lit ? light.u_px.values[i] : std::numeric_limits<double>::quiet_NaN();
    map.v_px.values[i] = lit ? light.v_px.values[i] : std::numeric_limits<double>::quiet_NaN();
    map.sigma_px.values[i] = lit ? 1e-3f : nan_f;
    map.valid.values[i] = lit;
    map.confidence.values[i] = lit ? 1.0f : 0.0f;
    map.why.values[i] = lit ? Reject::none : Reject::dim;
  }
  return map;
}

std::vector<ProjectorOutcome> run_trial(const Scene& scene, const Traced& traced, const TrialOptions& options,
                                        StageTimes& times, const ViewSink& sink, const Progress& progress) {
  if (comes_from_files(scene.patterns.kind) && !options.true_uv)
    throw InputError("[patterns]: pictures from files tell no pixel its place, expected coded patterns");
  const std::vector<ToldPoints> told = times.measure("surface", [&] { return told_points(scene, traced); });
  std::vector<ProjectorOutcome> outcomes;
  for (int p = 0; p < int(scene.projectors.size()); ++p) {
    ProjectorOutcome outcome;
    outcome.projector = p;
    outcome.name = scene.projectors[p].device.name;
    Correspondences correspondences;
    correspondences.cameras = told_cameras(scene);
    const PatternSequence sequence = pattern_sequence(scene, scene.projectors[p]);
    for (const View& view : traced.views) {
      if (view.projector != p) continue;
      if (progress)
        progress(fmt::format("\"{}\" plays its patterns, \"{}\" photographs and decodes them", outcome.name,
                             scene.cameras[view.camera].device.name));
      std::optional<CapturedStack> pictures;
      if (!options.true_uv) pictures = capture_view(scene, traced, view, options.seed, outcome.times);
      const DecodedMap decoded = outcome.times.measure("decode", [&] {
        return pictures ? decode(*pictures, sequence, options.decode) : true_map(view.light);
      });
      if (pictures) append_flags(*pictures, sequence, decoded, outcome);
      append_correspondences(decoded, told[view.camera], view.camera, options.block_px, correspondences);
      if (sink) sink(view, pictures ? &*pictures : nullptr, decoded);
    }
    outcome.correspondences = correspondences.world_points.size();
    if (progress)
      progress(
          fmt::format("solving for \"{}\" from {} correspondences", outcome.name, outcome.correspondences));
    judge(scene, traced, correspondences, options, outcome);
    add_doubts(outcome.solve, outcome.doubts);
    for (const auto& stage : outcome.times.stages) times.add(stage.name, stage.seconds);
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

int exit_code_of(const std::vector<ProjectorOutcome>& outcomes) {
  int code = 0;
  for (const ProjectorOutcome& outcome : outcomes) {
    if (outcome.solve.status == Status::refused) code = 3;
    if (outcome.solve.status == Status::weak && code == 0) code = 4;
  }
  return code;
}

}  // namespace laterna
