#include "apps/laterna/command.h"

#include "apps/lab/trial_report.h"
#include "sim/error.h"
#include "sim/scene_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace laterna {

namespace {

int projector_index(const Scene& scene, const std::string& name) {
  for (int p = 0; p < int(scene.projectors.size()); ++p) {
    if (scene.projectors[p].device.name == name || scene.projectors.size() == 1) return p;
  }
  throw InputError(fmt::format("the scene has no projector \"{}\", which the estimate names", name));
}

}  // namespace

void add_verify(CLI::App& app, Common& common) {
  struct Words {
    std::string scene, estimate;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(app, "verify", "laterna verify scene.toml estimate.json",
                                  "Compares an estimate with the scene's true projectors, in projector "
                                  "pixels over the lit surface, over the volume in\n"
                                  "front of the projector, and beyond it.");
  command->add_option("SCENE", words->scene, "Scene file with the truth")->required();
  command->add_option("ESTIMATE", words->estimate, "What `laterna calibrate -o` wrote")->required();
  command->callback([words, &common] {
    const Scene scene = load_scene(words->scene);
    const auto stored = read_estimates(words->estimate);
    if (stored.empty())
      throw Refusal(fmt::format("{}: holds no estimate that was not refused", words->estimate));
    StageTimes times;
    const Traced traced = trace(scene, times, [&](const std::string& line) { progress(common, line); });
    auto entries = nlohmann::json::array();
    for (const StoredEstimate& estimate : stored) {
      const int p = projector_index(scene, estimate.device.name);
      const Verification v =
          verify(scene.projectors[p].device, estimate.device, estimate.covariance, lit_points(traced, p));
      entries.push_back({{"name", estimate.device.name},
                         {"surface_error_px", error_json(v.surface)},
                         {"volume_error_px", error_json(v.volume)},
                         {"extrapolation_error_px", error_json(v.extrapolation)}});
      if (!common.json) fmt::print("projector \"{}\"\n{}", estimate.device.name, verification_text(v));
    }
    if (common.json) fmt::print("{}\n", nlohmann::json{{"projectors", entries}}.dump());
  });
}

}  // namespace laterna
