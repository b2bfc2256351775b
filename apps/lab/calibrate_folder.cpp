#include "apps/lab/calibrate_folder.h"

#include "apps/lab/trial.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <map>

namespace laterna {

namespace {

int camera_index(const Scene& scene, const CaptureSequence& sequence, const DecodedMap& map) {
  for (int c = 0; c < int(scene.cameras.size()); ++c) {
    const Device& device = scene.cameras[c].device;
    if (device.name != sequence.camera && scene.cameras.size() > 1) continue;
    if (device.intrinsics.size != glm::ivec2(map.width, map.height)) {
      throw InputError(fmt::format("pictures of \"{}\" are {} × {} px, expected the camera's {} × {}",
                                   sequence.camera, map.width, map.height, device.intrinsics.size.x,
                                   device.intrinsics.size.y));
    }
    return c;
  }
  throw InputError(fmt::format("the scene has no camera \"{}\", which the pictures name", sequence.camera));
}

// The lens model that the scene names for this projector; pinhole where it names none.
std::string lens_model(const Scene& scene, const std::string& projector) {
  for (const Projector& p : scene.projectors) {
    if (p.device.name == projector || scene.projectors.size() == 1) return p.device.lens.model;
  }
  return Lens{}.model;
}

struct Collected {
  glm::ivec2 size{0, 0};
  Correspondences correspondences;
  std::vector<std::string> flags, doubts;
};

}  // namespace

std::vector<FolderEstimate> calibrate_folder(const std::filesystem::path& folder,
                                             const CaptureManifest& manifest, const Scene& scene,
                                             const SolveOptions& solve_options,
                                             const DecodeOptions& decode_options, const KnownByName& known,
                                             const Progress& progress) {
  const ToldScene told(scene);
  std::map<int, ToldPoints> points;
  std::map<std::string, Collected> projectors;
  for (const CaptureSequence& sequence : manifest.sequences) {
    if (progress)
      progress(fmt::format("decoding {} pictures of \"{}\" by \"{}\"", sequence.pictures.size(),
                           sequence.projector, sequence.camera));
    const DecodedSequence decoded = decode_sequence(folder, sequence, decode_options);
    const DecodedMap& map = decoded.map;
    const int camera = camera_index(scene, sequence, map);
    if (!points.contains(camera)) points.emplace(camera, told.trace(camera));
    Collected& collected = projectors[sequence.projector];
    collected.correspondences.cameras = told_cameras(scene);
    collected.size = sequence.projector_size;
    const auto seen_by = [&](const std::string& words) {
      return fmt::format("seen by \"{}\": {}", sequence.camera, words);
    };
    for (const std::string& flag : decoded.report.flags) collected.flags.push_back(seen_by(flag));
    for (const std::string& doubt : decoded.report.doubts) collected.doubts.push_back(seen_by(doubt));
    append_correspondences(map, points.at(camera), camera, TrialOptions{}.block_px,
                           collected.correspondences);
  }
  for (const auto& [name, intrinsics] : known)
    if (!name.empty() && !projectors.contains(name))
      throw InputError(fmt::format("known intrinsics: the pictures show no projector \"{}\"", name));
  std::vector<FolderEstimate> estimates;
  for (const auto& [name, collected] : projectors) {
    FolderEstimate estimate{name, collected.correspondences.world_points.size(), {}, collected.flags};
    if (progress)
      progress(fmt::format("solving for \"{}\" from {} correspondences", name, estimate.correspondences));
    SolveOptions options = solve_options;
    options.lens_model = lens_model(scene, name);
    options.known = known_for(known, name);
    if (estimate.correspondences == 0) {
      estimate.solve.reason =
          "no overlap: no camera pixel sees light of this projector that could be decoded";
    } else {
      estimate.solve = solve(collected.correspondences, collected.size, options);
    }
    add_doubts(estimate.solve, collected.doubts);
    estimate.solve.estimate.name = name;
    estimates.push_back(std::move(estimate));
  }
  return estimates;
}

}  // namespace laterna
