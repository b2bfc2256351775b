// Recovers a projector through the installed libraries.
#include <apps/lab/trial.h>
#include <sim/scene_build.h>
#include <sim/scene_file.h>

#include <cstdio>

int main() {
  const char* text = R"(
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.7]
[[projector]]
size = [320, 200]
throw_ratio = 1.2
position = [0.35, -0.1, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [400, 250]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
)";
  const laterna::Scene scene = laterna::build_scene(laterna::parse_scene(text, "outside"), ".");
  laterna::StageTimes times;
  const auto outcomes = laterna::run_trial(scene, laterna::trace(scene, times), {}, times);
  std::printf("volume error %.4f px\n", outcomes.at(0).verification.volume.rms);
  return laterna::exit_code_of(outcomes);
}
