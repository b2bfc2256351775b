#include "apps/lab/score/cloud_score.h"

#include "apps/lab/capture_cloud.h"
#include "apps/lab/score/cloud_errors.h"
#include "apps/lab/score/cloud_suspects.h"
#include "apps/lab/trial.h"
#include "render/effects/apply_effects.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double beyond_bound = 2, outlier_factor = 3, most_factor = 10;

const Device& device_of(const Camera& camera) { return camera.device; }
const Device& device_of(const Projector& projector) { return projector.device; }

// The index of the device whose pixels a cloud has.
template <class Devices>
std::size_t index_of(const Devices& devices, const std::string& name, const char* kind) {
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (device_of(devices[i]).name == name || (name.empty() && devices.size() == 1)) return i;
  throw InputError(name.empty() ? fmt::format("the cloud has pixels of a {0}, and the scene has {1} of them, "
                                              "expected --{0} NAME",
                                              kind, devices.size())
                                : fmt::format("--{}: the scene has none called \"{}\"", kind, name));
}

Rigid world_from_frame(const Scene& scene, const std::string& frame) {
  if (frame.empty()) return {};
  for (const Camera& camera : scene.cameras)
    if (camera.device.name == frame) return inverse(camera.device.device_from_world);
  for (const Projector& projector : scene.projectors)
    if (projector.device.name == frame) return inverse(projector.device.device_from_world);
  throw InputError(fmt::format("--frame: the scene has no device \"{}\"", frame));
}

// The diagonal of the box around meshes and devices.
double diagonal_m(const Scene& scene) {
  std::vector<glm::dvec3> points;
  for (const Object& object : scene.objects) {
    const std::vector<glm::dvec3> vertices = world_positions(object);
    points.insert(points.end(), vertices.begin(), vertices.end());
  }
  for (const Camera& camera : scene.cameras)
    points.push_back(center_in_world(camera.device.device_from_world));
  for (const Projector& p : scene.projectors) points.push_back(center_in_world(p.device.device_from_world));
  glm::dvec3 low = points.front(), high = low;
  for (const glm::dvec3& x : points) low = glm::min(low, x), high = glm::max(high, x);
  return glm::distance(low, high);
}

// A scene, traced, and the cloud's place in it.
class Bench {
 public:
  Bench(const Scene& scene, const PointCloud& cloud, const CloudScoreOptions& options,
        const Progress& progress)
      : scene_(scene),
        options_(options),
        traced_(trace(scene, times_, progress)),
        query_(traced_.rays, traced_.as_seen(scene)) {
    ground_.surface = &query_;
    ground_.farthest_m = diagonal_m(traced_.as_seen(scene));
    if (cloud.has_camera_px)
      ground_.camera = scene.cameras[index_of(scene.cameras, options.camera, "camera")].device;
    if (cloud.has_projector_px)
      ground_.projector = scene.projectors[index_of(scene.projectors, options.projector, "projector")].device;
    for (int p = 0; p < int(scene.projectors.size()); ++p) {
      const Device& device = scene.projectors[p].device;
      if (ground_.projector && ground_.projector->name != device.name) continue;
      for (const glm::dvec3& x : lit_points(traced_, p)) {
        lit_.push_back(x);
        widths_m_.push_back(apply(device.device_from_world, x).z /
                            std::sqrt(device.intrinsics.fx * device.intrinsics.fy));
      }
    }
    if (lit_.empty())
      throw InputError("the scene's projectors light nothing that a camera of the scene sees");
  }

  const CloudGround& ground() const { return ground_; }
  double spread() const { return spread_m(lit_); }
  double tolerance_m() const {
    double sum = 0;
    for (const double width : widths_m_) sum += width;
    return options_.tolerance_px * sum / double(widths_m_.size());
  }

  /// The points that the scene's pictures give when the true devices intersect them; empty: no coded
  /// patterns.
  std::vector<CloudPoint> reference(const Progress& progress) {
    std::vector<CloudPoint> points;
    if (!is_coded(scene_.patterns.kind)) return points;
    for (const View& view : traced_.views) {
      const Camera& camera = scene_.cameras[view.camera];
      const Projector& projector = scene_.projectors[view.projector];
      if ((ground_.camera && ground_.camera->name != camera.device.name) ||
          (ground_.projector && ground_.projector->name != projector.device.name))
        continue;
      if (progress)
        progress(fmt::format("what noise alone makes: \"{}\" photographs \"{}\"", camera.device.name,
                             projector.device.name));
      const CapturedStack pictures = capture_view(scene_, traced_, view, options_.seed, times_);
      const DecodedMap map = decode(pictures, pattern_sequence(scene_, projector), {});
      append_cloud(map, camera.device, projector.device, points);
    }
    return points;
  }

 private:
  const Scene& scene_;
  const CloudScoreOptions& options_;
  StageTimes times_;
  Traced traced_;
  SurfaceQuery query_;
  CloudGround ground_;
  std::vector<glm::dvec3> lit_;
  std::vector<double> widths_m_;
};

CloudMeasures measures(const CloudErrors& errors) {
  return {1000 * rms_of(errors.surface_m), 1000 * rms_of(errors.point_m), rms_of(errors.projector_px)};
}

void align_cloud(const CloudGround& ground, const Alignment& alignment, std::vector<CloudPoint>& points) {
  if (!alignment.world && !alignment.scale) return;
  if (!ground.camera && !ground.projector)
    throw InputError(fmt::format(
        "--align {}: the cloud's points have no pixels that say where they belong, expected the properties "
        "camera_u and camera_v, or projector_u and projector_v",
        alignment_word(alignment)));
  const auto fit = aligned_to(points, true_points(ground, points), {alignment.world, alignment.scale});
  if (!fit)
    throw InputError(
        fmt::format("--align {}: fewer than three points of the cloud, or only points on one "
                    "line, have pixels that see the surface",
                    alignment_word(alignment)));
  for (CloudPoint& p : points) p.x_world = apply(*fit, p.x_world);
}

double larger(double bound, double tolerance) {
  return std::isfinite(bound) ? std::max(bound, tolerance) : tolerance;
}

bool is_ok(double error, double bound, double tolerance) {
  return std::isnan(error) || error <= larger(beyond_bound * bound, tolerance);
}

// Everything but the verdict.
CloudScore measured(const Bench& bench, const std::vector<CloudPoint>& points,
                    const std::vector<CloudPoint>& reference, const CloudScoreOptions& options) {
  const CloudGround& ground = bench.ground();
  const std::vector<glm::dvec3> true_of = true_points(ground, points);
  const CloudErrors errors = cloud_errors(ground, points, true_of);
  const CloudErrors noise = cloud_errors(ground, reference, true_points(ground, reference));
  CloudScore score;
  score.points = points.size();
  score.alignment = options.alignment;
  score.frame = options.frame;
  score.error = measures(errors);
  score.bound = measures(noise);
  score.median_mm = 1000 * quantile_of(errors.surface_m, 0.5);
  score.p95_mm = 1000 * quantile_of(errors.surface_m, 0.95);
  const double usual_mm = larger(1000 * quantile_of(noise.surface_m, 0.95), 1000 * bench.tolerance_m());
  score.outlier_limit_mm = options.outlier_mm > 0 ? options.outlier_mm : outlier_factor * usual_mm;
  const auto is_outlier = [&](double d) { return 1000 * d > score.outlier_limit_mm; };
  const auto is_missing = [](const glm::dvec3& x) { return std::isnan(x.x); };
  score.outliers = std::size_t(std::count_if(errors.surface_m.begin(), errors.surface_m.end(), is_outlier));
  score.no_true_point = std::size_t(std::count_if(true_of.begin(), true_of.end(), is_missing));
  return score;
}

Status status_of(const CloudScore& s, double tolerance_mm, double tolerance_px) {
  return is_ok(s.error.surface_mm, s.bound.surface_mm, tolerance_mm) &&
                 is_ok(s.error.point_mm, s.bound.point_mm, tolerance_mm) &&
                 is_ok(s.error.projector_px, s.bound.projector_px, tolerance_px)
             ? Status::ok
             : Status::weak;
}

}  // namespace

CloudScore score_cloud(const ScoreTruth& truth, PointCloud cloud, const CloudScoreOptions& options,
                       const Progress& progress) {
  const Rigid to_world = world_from_frame(truth.scene, options.frame);
  for (CloudPoint& p : cloud.points) p.x_world = apply(to_world, p.x_world);
  Bench bench(truth.scene, cloud, options, progress);
  const CloudGround& ground = bench.ground();
  std::vector<CloudPoint> points = cloud.points;
  align_cloud(ground, options.alignment, points);
  CloudScore score = measured(bench, points, bench.reference(progress), options);
  const double tolerance_mm = 1000 * bench.tolerance_m();
  score.status = status_of(score, tolerance_mm, options.tolerance_px);
  if (score.status == Status::ok) return score;
  const double bound_mm = ground.camera ? score.bound.point_mm : score.bound.surface_mm;
  const CloudScale scale{larger(bound_mm, tolerance_mm) / 1000,
                         larger(score.bound.projector_px, options.tolerance_px),
                         most_factor * score.outlier_limit_mm / 1000, bench.spread()};
  CloudSuspects found = cloud_suspects(truth.scene, ground, cloud.points, options.alignment, scale);
  score.suspects = std::move(found.suspects);
  score.better_frame = std::move(found.better_frame);
  return score;
}

}  // namespace laterna
