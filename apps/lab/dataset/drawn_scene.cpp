#include "apps/lab/dataset/drawn_scene.h"

#include "apps/lab/capture_writer.h"
#include "sim/error.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

#include <functional>
#include <ranges>

namespace laterna {

namespace {

using Json = nlohmann::json;
using Choose = std::function<Json(const Distribution&, const std::string& path)>;

// A value as scene paths: tables become their keys, distributions what `choose` makes of them.
void add(DrawnValues& drawn, const std::string& path, const Json& value, const Choose& choose) {
  if (is_distribution(value)) return add(drawn, path, choose(value, path), choose);
  if (!value.is_object()) return drawn.values.emplace_back(path, value), void();
  for (const auto& [key, inner] : value.items()) add(drawn, fmt::format("{}.{}", path, key), inner, choose);
}

std::vector<std::string> overrides_of(const DrawnValues& drawn) {
  std::vector<std::string> texts;
  for (const auto& [path, value] : drawn.values) texts.push_back(fmt::format("{}={}", path, value.dump()));
  return texts;
}

Choose drawing(std::uint64_t seed, std::uint64_t sample, std::uint64_t attempt) {
  return [=](const Distribution& d, const std::string& path) {
    RandomStream stream(seed, sample, attempt, path);
    return draw(d, stream);
  };
}

}  // namespace

DrawnValues draw_values(const DatasetSpec& spec, std::uint64_t seed, std::uint64_t sample,
                        std::uint64_t attempt) {
  DrawnValues drawn;
  for (const RandomKey& key : spec.random)
    add(drawn, key.path, key.distribution, drawing(seed, sample, attempt));
  for (const PresentKey& key : spec.present)
    if (RandomStream(seed, sample, attempt, fmt::format("present mesh.{}", key.mesh)).unit() >= key.share)
      drawn.absent.push_back(key.mesh);
  return drawn;
}

SceneSpec scene_of(const DatasetSpec& spec, const DrawnValues& drawn) {
  SceneSpec scene = parse_scene(spec.scene_text, spec.scene_file.string(), overrides_of(drawn));
  for (const int mesh : drawn.absent | std::views::reverse) {
    if (std::size_t(mesh) >= scene.meshes.size())
      throw InputError(
          fmt::format("present \"mesh.{}\": the scene has {} meshes", mesh, scene.meshes.size()));
    scene.meshes.erase(scene.meshes.begin() + mesh);
  }
  return scene;
}

namespace {

// The first sample's values, with key k's distribution replaced; null leaves the key out.
DrawnValues drawn_with(const DatasetSpec& spec, std::uint64_t seed, std::size_t k, const Json& instead) {
  DrawnValues drawn;
  for (const RandomKey& key : spec.random) {
    const Json& value = key.place == spec.random[k].place ? instead : key.distribution;
    if (!value.is_null()) add(drawn, key.path, value, drawing(seed, 0, 0));
  }
  return drawn;
}

// What is wrong with a scene of these values; empty where nothing is.
std::string fault_of(const DatasetSpec& spec, const DrawnValues& drawn, bool with_files) {
  try {
    const SceneSpec scene = scene_of(spec, drawn);
    if (with_files)
      check_format(spec.settings.format, build_scene(scene, spec.scene_file.parent_path()), "format");
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

void check_ends(const DatasetSpec& spec, std::uint64_t seed) {
  const auto refuse = [&](std::size_t k, const std::string& fault) {
    throw InputError(fmt::format("{}: {}", spec.random[k].place, fault));
  };
  DrawnValues first = draw_values(spec, seed, 0, 0);
  first.absent.clear();
  const std::string fault = fault_of(spec, first, true);
  for (std::size_t k = 0; !fault.empty() && k < spec.random.size(); ++k)  // the key without which it is sound
    if (fault_of(spec, drawn_with(spec, seed, k, nullptr), true).empty()) refuse(k, fault);
  if (!fault.empty()) throw InputError(fault);
  for (const PresentKey& key : spec.present) first.absent.push_back(key.mesh);
  scene_of(spec, first);
  for (std::size_t k = 0; k < spec.random.size(); ++k) {
    const bool with_files = spec.random[k].distribution.contains("choice");
    for (const Json& end : ends_of(spec.random[k].distribution)) {
      const std::string at_end = fault_of(spec, drawn_with(spec, seed, k, end), with_files);
      if (!at_end.empty()) refuse(k, at_end);
    }
  }
}

}  // namespace laterna
