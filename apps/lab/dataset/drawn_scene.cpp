#include "apps/lab/dataset/drawn_scene.h"

#include "sim/error.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

#include <functional>

namespace laterna {

namespace {

using Json = nlohmann::json;
using Choose = std::function<Json(const Distribution&, const std::string& path)>;

// A value as scene paths: tables become their keys, distributions what `choose` makes of them.
void add(DrawnValues& drawn, const std::string& path, const Json& value, const Choose& choose) {
  if (is_distribution(value)) return add(drawn, path, choose(value, path), choose);
  if (!value.is_object()) return drawn.values.emplace_back(path, value), void();
  for (const auto& [key, inner] : value.items()) add(drawn, path + "." + key, inner, choose);
}

std::vector<std::string> overrides_of(const DrawnValues& drawn) {
  std::vector<std::string> texts;
  for (const auto& [path, value] : drawn.values) texts.push_back(path + "=" + value.dump());
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
  for (auto mesh = drawn.absent.rbegin(); mesh != drawn.absent.rend(); ++mesh) {
    if (std::size_t(*mesh) >= scene.meshes.size())
      throw InputError(
          fmt::format("present \"mesh.{}\": the scene has {} meshes", *mesh, scene.meshes.size()));
    scene.meshes.erase(scene.meshes.begin() + *mesh);
  }
  if (scene.meshes.empty()) throw InputError("present: no mesh is left");
  return scene;
}

void check_ends(const DatasetSpec& spec, std::uint64_t seed) {
  for (const RandomKey& key : spec.random) {
    for (const Json& end : ends_of(key.distribution)) {
      DrawnValues drawn;
      for (const RandomKey& other : spec.random)
        add(drawn, other.path, other.place == key.place ? end : Json(other.distribution),
            drawing(seed, 0, 0));
      try {
        const SceneSpec scene = scene_of(spec, drawn);
        if (key.distribution.contains("choice")) build_scene(scene, spec.scene_file.parent_path());
      } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", key.place, error.what()));
      }
    }
  }
  build_scene(scene_of(spec, draw_values(spec, seed, 0, 0)), spec.scene_file.parent_path());
}

}  // namespace laterna
