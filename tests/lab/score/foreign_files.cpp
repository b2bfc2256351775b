#include "tests/lab/score/foreign_files.h"

#include "sim/error.h"

#include <iterator>
#include <optional>
#include <vector>

namespace laterna::testing {

namespace {

struct FileKind {
  const char *name, *path;
  bool keeps_world;
};

constexpr FileKind formats[] = {{"estimate", "r.json", true},      {"opencv", "r.yml", true},
                                {"opencv-stereo", "s.yml", false}, {"scan3d", "c.yml", false},
                                {"colmap", "colmap", true},        {"kalibr", "k.yaml", false},
                                {"bop", "b.json", true},           {"gltf", "g.gltf", true},
                                {"usd", "u.usda", true},           {"mrcal", "cameramodels", true}};

// None where the format cannot hold it (a lens, an improper pose).
std::optional<ScoreResult> through(const Rig& rig, const FileKind& format,
                                   const std::filesystem::path& folder, const RigReadOptions& options) {
  const auto path = folder / format.path;
  std::filesystem::remove_all(path);
  try {
    Notes notes;
    write_rig(path, rig_texts(rig, path, format.name, 1, notes));
    return read_score_result(path, options);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

ToldResult told_by_a_file(const Rig& rig, std::size_t first, const std::filesystem::path& folder,
                          const RigReadOptions& options) {
  for (std::size_t i = 0; i < std::size(formats); ++i) {
    const FileKind& format = formats[(first + i) % std::size(formats)];
    if (!format.keeps_world && rig.cameras[0].device_from_world.translation != glm::dvec3(0.0)) continue;
    auto found = through(rig, format, folder, options);
    if (found && !found->rig.cameras.empty()) return {*found, format.name};
  }
  return {{rig, std::vector<std::vector<double>>(rig.projectors.size())}, ""};
}

}  // namespace laterna::testing
