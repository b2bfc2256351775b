#include "apps/lab/roundtrip_folder.h"

#include "apps/lab/decode_folder.h"
#include "apps/lab/live_page.h"
#include "apps/lab/report/thumbnails.h"
#include "apps/lab/report/trial_figures.h"
#include "apps/lab/summary_picture.h"
#include "apps/lab/trial_report.h"
#include "render/effects/apply_effects.h"
#include "sim/formats/exr_camera.h"
#include "sim/image_file.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <optional>

namespace laterna {

namespace {

// What a view leaves for its picture once its pictures are dropped.
struct Kept {
  const View* view;
  Image<float> white;
  DecodedMap decoded;
  nlohmann::json frames;  // [{"label", "file"}]
};

std::string stem_of(const Scene& scene, const View& view) {
  return fmt::format("{}_{}", scene.cameras[view.camera].device.name,
                     scene.projectors[view.projector].device.name);
}

// The pictures, small, for people to leaf through.
nlohmann::json write_frames(const Scene& scene, const View& view, const PatternSequence& sequence,
                            const CapturedStack* pictures, int full_scale,
                            const std::filesystem::path& root) {
  nlohmann::json frames = nlohmann::json::array();
  if (!pictures) return frames;
  const std::string folder = "frames/" + stem_of(scene, view);
  std::filesystem::create_directories(root / folder);
  const std::vector<Image<std::uint8_t>> small = thumbnails(*pictures, full_scale);
  const std::vector<std::string> labels = frame_labels(sequence, int(small.size()));
  for (std::size_t k = 0; k < small.size(); ++k) {
    frames.push_back({{"label", labels[k]}, {"file", fmt::format("{}/{:02}.png", folder, k)}});
    write_picture(root / frames.back()["file"].get<std::string>(), small[k]);
  }
  return frames;
}

// Residuals, projections and the rig: trial_figures.h.
nlohmann::json figures_json(const Scene& scene, const Traced& traced, const std::vector<Kept>& kept,
                            const std::vector<ProjectorOutcome>& outcomes) {
  nlohmann::json json{{"rig", rig_figure(scene)},
                      {"points", nlohmann::json::array()},
                      {"residuals", nlohmann::json::array()},
                      {"projections", nlohmann::json::array()},
                      {"views", nlohmann::json::array()}};
  const std::vector<ToldPoints> told = told_points(scene, traced);
  for (const Kept& k : kept) {
    const ProjectorOutcome& o = outcomes[k.view->projector];
    const glm::ivec2 size = scene.projectors[o.projector].device.intrinsics.size;
    json["views"].push_back({{"camera", scene.cameras[k.view->camera].device.name},
                             {"projector", o.name},
                             {"projector_size", {size.x, size.y}},
                             {"decoded", "decoded_" + stem_of(scene, *k.view) + ".exr"},
                             {"frames", k.frames}});
    if (o.solve.status == Status::refused) continue;
    json["residuals"].push_back(residual_figure(k.decoded, told[k.view->camera].points_world,
                                                o.solve.estimate, scene.cameras[k.view->camera].device.name,
                                                o.name));
  }
  std::vector<glm::dvec3> all;
  for (const ProjectorOutcome& o : outcomes) {
    const LargeVector<glm::dvec3> lit = lit_points(traced, o.projector);
    all.insert(all.end(), lit.begin(), lit.end());
    if (o.solve.status != Status::refused)
      json["projections"].push_back(
          projection_figure(scene.projectors[o.projector].device, o.solve.estimate, o.solve.covariance, lit));
  }
  json["points"] = points_figure(all);
  return json;
}

Image<float> white_frame(const CapturedStack* pictures, const PatternSequence& sequence, const View& view,
                         int full_scale) {
  Image<float> white(view.light.width, view.light.height);
  if (!pictures) {
    for (std::size_t i = 0; i < white.values.size(); ++i) white.values[i] = view.light.lit(i) ? 1.0f : 0.0f;
    return white;
  }
  std::visit(
      [&](const auto& stack) {
        const auto picture = stack.picture(white_picture(sequence));
        for (std::size_t i = 0; i < white.values.size(); ++i)
          white.values[i] = float(picture[i]) / float(full_scale);
      },
      *pictures);
  return white;
}

// The outcome's errors back on the pixels of one view: they stand in the order of lit pixels, view by view.
Image<float> error_image(const Traced& traced, const View& view, const ProjectorOutcome& outcome) {
  if (outcome.surface_error_px.empty()) return {};
  Image<float> image(view.light.width, view.light.height, std::numeric_limits<float>::quiet_NaN());
  std::size_t next = 0;
  for (const View& other : traced.views) {
    if (other.projector != view.projector) continue;
    for (std::size_t i = 0; i < other.light.why.values.size(); ++i) {
      if (!other.light.lit(i)) continue;
      if (&other == &view) image.values[i] = outcome.surface_error_px[next];
      ++next;
    }
  }
  return image;
}

SummaryPanels panels_of(const Scene& scene, const std::string& scene_name, const Traced& traced,
                        const Kept& kept, const ProjectorOutcome& outcome) {
  SummaryPanels panels;
  panels.title = fmt::format("{}: projector \"{}\" seen by \"{}\": {}", scene_name, outcome.name,
                             scene.cameras[kept.view->camera].device.name, status_word(outcome.solve.status));
  const Verification& v = outcome.verification;
  if (outcome.solve.status != Status::refused) {
    panels.lines.push_back(
        fmt::format("error over the volume {:.4f} px rms (noise predicts {:.4f}), on the surface {:.4f} px "
                    "(noise predicts {:.4f})",
                    v.volume.rms, v.volume.predicted_rms, v.surface.rms, v.surface.predicted_rms));
  }
  if (!outcome.solve.reason.empty()) panels.lines.push_back(outcome.solve.reason);
  panels.white = kept.white;
  panels.decoded = &kept.decoded;
  panels.projector_size = scene.projectors[outcome.projector].device.intrinsics.size;
  panels.error_px = error_image(traced, *kept.view, outcome);
  return panels;
}

void write_results(const Scene& scene, const std::string& scene_name, const Traced& traced,
                   const std::vector<Kept>& kept, const std::filesystem::path& root, RoundtripOutput& out) {
  std::vector<nlohmann::json> estimates;
  for (const ProjectorOutcome& o : out.outcomes) estimates.push_back(estimate_json(o.name, o.solve));
  for (const Kept& k : kept) {
    const ProjectorOutcome& outcome = out.outcomes[k.view->projector];
    const std::string stem = stem_of(scene, *k.view);
    out.files.push_back("summary_" + stem + ".png");
    write_canvas(root / out.files.back(), summary_picture(panels_of(scene, scene_name, traced, k, outcome)));
    write_decoded(root / ("decoded_" + stem + ".exr"), k.decoded,
                  picture_camera(scene.cameras[k.view->camera].device));
  }
  for (const Kept& k : kept) out.files.push_back("decoded_" + stem_of(scene, *k.view) + ".exr");
  write_file(root / "estimate.json", estimates_text(estimates, scene));
  write_file(root / "result.json", trial_json(scene, out.outcomes, out.times).dump(2) + "\n");
  write_file(root / "figures.json", figures_json(scene, traced, kept, out.outcomes).dump() + "\n");
  write_file(root / "live.json", live_json(scene, traced, scene_name).dump() + "\n");
  out.files.insert(out.files.end(), {"estimate.json", "result.json", "figures.json", "live.json"});
}

}  // namespace

RoundtripOutput roundtrip(const Scene& scene, const std::string& scene_name,
                          const std::filesystem::path& target, const TrialOptions& options,
                          const Progress& progress) {
  std::optional<PendingFolder> folder;
  if (!target.empty()) folder.emplace(target);
  RoundtripOutput out;
  const Traced traced = trace(scene, out.times, progress);
  std::vector<Kept> kept;
  const auto keep = [&](const View& view, const CapturedStack* pictures, const DecodedMap& decoded) {
    if (!folder) return;
    const int full_scale = (1 << scene.cameras[view.camera].sensor.bit_depth) - 1;
    const PatternSequence sequence = pattern_sequence(scene, scene.projectors[view.projector]);
    kept.push_back({&view, white_frame(pictures, sequence, view, full_scale), decoded,
                    write_frames(scene, view, sequence, pictures, full_scale, folder->path())});
  };
  out.outcomes = run_trial(scene, traced, options, out.times, keep, progress);
  if (folder) {
    out.times.measure("write", [&] { write_results(scene, scene_name, traced, kept, folder->path(), out); });
    folder->commit();
  }
  return out;
}

}  // namespace laterna
