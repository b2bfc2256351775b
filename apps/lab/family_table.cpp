#include "apps/lab/family_table.h"

#include "apps/lab/trial_report.h"
#include "render/effects/apply_effects.h"
#include "sim/scene_build.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace laterna {

namespace {

constexpr double nan_d = std::numeric_limits<double>::quiet_NaN();

constexpr const char* relief_scene = R"(
[[mesh]]
shape = "relief"
shape_size = [1.6, 1.0, 0.7]
seed = 7
[[projector]]
size = [256, 192]
throw_ratio = 1.2
lens_shift = [0.0, 0.1]
lookup = "bilinear"
position = [0.35, -0.1, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [480, 300]
fov_x_deg = 42
position = [-0.35, 0.15, 2.0]
look_at = [0, 0, 0]
up = [0.1, 1, 0]
sensor = { noise_sigma_dn = 0.7 }
)";

constexpr const char* groove_scene = R"(
[[mesh]]
shape = "v_groove"
shape_size = [1.4, 1.0, 0.7]
albedo = 0.8
[[projector]]
size = [256, 192]
throw_ratio = 1.4
lookup = "bilinear"
position = [0.25, 0, 2.1]
look_at = [0, 0, 0]
up = [0, 1, 0]
[[camera]]
size = [400, 300]
fov_x_deg = 40
position = [-0.3, 0.1, 2.0]
look_at = [0, 0, 0]
up = [0, 1, 0]
sensor = { noise_sigma_dn = 0.7 }
)";

PatternSequence sequence_of(const SceneSpec& spec) {
  return {spec.patterns.parameters, *spec.projectors[0].device.size};
}

/// The first picture of the last group of columns: the finest bit, or the last fringe with several steps.
int finest_column_picture(const PatternSequence& sequence) {
  int first = 0;
  for (const PatternGroup& group : pattern_groups(sequence))
    if (group.axis == 0 && group.count > 1) first = group.first;
  return first;
}

int first_row_picture(const PatternSequence& sequence) {
  const auto groups = pattern_groups(sequence);
  return std::find_if(groups.begin(), groups.end(), [](const PatternGroup& g) { return g.axis == 1; })->first;
}

void lose(SceneSpec& spec, int picture) {
  spec.effects.timing = true;
  spec.timing.dropped_frame = picture, spec.timing.repeated_frame = picture + 1;
}

void move_camera(SceneSpec& spec) {
  spec.effects.timing = true;
  spec.timing.moved = {"camera", first_row_picture(sequence_of(spec)), {0, 0, 0}, {0.02, 0, 0}};
}

void apply(Fault fault, SceneSpec& spec) {
  ProjectorEffects& projector = spec.projectors[0].effects;
  switch (fault) {
    case Fault::none:
    case Fault::saturation:  // it needs the exposure of the scene, below
      return;
    case Fault::gamma:
      spec.effects.response = true, projector.response_exponent = 2.2;
      return;
    case Fault::defocus:
      spec.effects.projector_defocus = true;
      projector.optics.aperture_m = 0.06, projector.optics.focus_m = 1.2;
      return;
    case Fault::interreflection:
      spec.effects.inter_reflection = true, spec.inter_reflection = {3, 16};
      return;
    case Fault::dropped:
      spec.effects.timing = true, spec.timing.dropped_frame = 1;
      return;
    case Fault::lost_fine:
      return lose(spec, finest_column_picture(sequence_of(spec)) + 1);
    case Fault::lost_coarse:
      return lose(spec, 1);
    case Fault::moved:
      return move_camera(spec);
    case Fault::moved_and_repeated:
      spec.patterns.parameters.repeat_first = true;
      return move_camera(spec);
  }
}

/// Automatic exposure leaves white below full scale nearly everywhere; the median pixel shall be over it.
void overexpose(Scene& scene) {
  const int white_index = white_picture(pattern_sequence(scene, scene.projectors[0]));
  StageTimes times;
  const Traced traced = trace(scene, times);
  const CapturedStack stack = capture_view(scene, traced, traced.views[0], 1, times);
  const auto& pictures = std::get<ImageStack<std::uint8_t>>(stack);
  std::vector<int> white;
  for (std::size_t i = 0; i < pictures.picture_size(); ++i)
    if (traced.views[0].light.lit(i)) white.push_back(pictures.picture(white_index)[i]);
  std::nth_element(white.begin(), white.begin() + std::ptrdiff_t(white.size() / 2), white.end());
  const double median_share = white[white.size() / 2] / 255.0;
  scene.cameras[0].sensor.saturation_cd_per_m2 = traced.views[0].saturation_cd_per_m2 * median_share / 1.6;
}

void measure_decoding(const View& view, const DecodedMap& map, FamilyCell& cell) {
  std::vector<double> squared;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < map.valid.values.size(); ++i) {
    if (!view.light.lit(i)) continue;
    ++lit;
    if (!map.valid.values[i]) continue;
    const double du = map.u_px.values[i] - view.light.u_px.values[i];
    const double dv = map.v_px.values[i] - view.light.v_px.values[i];
    squared.push_back(du * du + dv * dv);
  }
  cell.valid_share = lit ? double(squared.size()) / double(lit) : 0;
  if (squared.empty()) {
    cell.decoded_rms_px = cell.decoded_median_px = nan_d;
    return;
  }
  double sum = 0;
  for (const double s : squared) sum += s;
  cell.decoded_rms_px = std::sqrt(sum / double(squared.size()));
  const auto middle = squared.begin() + std::ptrdiff_t(squared.size() / 2);
  std::nth_element(squared.begin(), middle, squared.end());
  cell.decoded_median_px = std::sqrt(*middle);
}

Ending ending_of(const FamilyCell& cell) {
  if (cell.status == Status::refused) return Ending::refused;
  if (cell.status == Status::weak) return Ending::weak;
  if (cell.true_rms_px <= std::max(5 * cell.predicted_rms_px, 1e-6)) return Ending::right;
  return cell.flags.empty() ? Ending::silently_wrong : Ending::flagged;
}

}  // namespace

std::vector<NamedPatterns> table_families() {
  using K = PatternKind;
  return {{"gray", {.kind = K::gray}},
          {"xor_gray", {.kind = K::xor_gray}},
          {"gray_phase N=3", {.kind = K::gray_phase, .steps = 3, .pitch_px = 32}},
          {"gray_phase N=4", {.kind = K::gray_phase, .steps = 4, .pitch_px = 32}},
          {"gray_phase N=8", {.kind = K::gray_phase, .steps = 8, .pitch_px = 32}},
          {"phase", {.kind = K::phase, .steps = 4, .pitch_px = 32}},
          {"multi_frequency", {.kind = K::multi_frequency, .steps = 4, .pitch_px = 32}},
          {"micro_phase", {.kind = K::micro_phase, .steps = 4, .pitch_px = 32}}};
}

const char* fault_name(Fault fault) {
  constexpr std::array names{"none",    "gamma 2.2", "saturation",  "defocus", "inter-reflection",
                             "dropped", "lost fine", "lost coarse", "moved",   "moved, repeated"};
  return names[std::size_t(fault)];
}

std::vector<Fault> all_faults() {
  return {Fault::none,    Fault::gamma,     Fault::saturation,  Fault::defocus, Fault::interreflection,
          Fault::dropped, Fault::lost_fine, Fault::lost_coarse, Fault::moved,   Fault::moved_and_repeated};
}

const char* ending_name(Ending ending) {
  constexpr std::array names{"right", "weak", "refused", "flagged", "SILENTLY WRONG"};
  return names[std::size_t(ending)];
}

FamilyCell family_cell(const NamedPatterns& family, Fault fault, std::uint64_t seed) {
  SceneSpec spec =
      with_names(parse_scene(fault == Fault::interreflection ? groove_scene : relief_scene, "table.toml"));
  spec.patterns.parameters = family.patterns;
  apply(fault, spec);
  Scene scene = build_scene(spec, ".");
  if (fault == Fault::saturation) overexpose(scene);
  FamilyCell cell;
  cell.family = family.name, cell.fault = fault;
  StageTimes times;
  TrialOptions options;
  options.seed = seed;
  const ProjectorOutcome outcome =
      run_trial(scene, trace(scene, times), options, times,
                [&](const View& view, const CapturedStack*, const DecodedMap& map) {
                  measure_decoding(view, map, cell);
                })
          .at(0);
  cell.status = outcome.solve.status, cell.reason = outcome.solve.reason, cell.flags = outcome.flags;
  const bool solved = cell.status != Status::refused;
  cell.true_rms_px = solved ? outcome.verification.volume.rms : nan_d;
  cell.predicted_rms_px = solved ? outcome.verification.volume.predicted_rms : nan_d;
  cell.ending = ending_of(cell);
  return cell;
}

std::vector<FamilyCell> family_table(const std::vector<NamedPatterns>& families,
                                     const std::vector<Fault>& faults) {
  std::vector<FamilyCell> cells;
  for (const Fault fault : faults)
    for (const NamedPatterns& family : families) cells.push_back(family_cell(family, fault));
  return cells;
}

std::string family_table_text(const std::vector<FamilyCell>& cells) {
  std::string text = fmt::format("{:<17}{:<17}{:>9} {:>9} {:>7}  {:<8}{:>10} {:>10}  {}\n", "fault", "family",
                                 "decoded", "median", "valid", "verdict", "true", "predicted", "ends");
  text += fmt::format("{:<34}{:>9} {:>9} {:>7}  {:<8}{:>10} {:>10}\n", "", "rms px", "px", "of lit", "",
                      "volume px", "volume px");
  for (const FamilyCell& c : cells) {
    text +=
        fmt::format("{:<17}{:<17}{:>9.4f} {:>9.4f} {:>6.1f}%  {:<8}{:>10.4f} {:>10.4f}  {}\n",
                    fault_name(c.fault), c.family, c.decoded_rms_px, c.decoded_median_px, 100 * c.valid_share,
                    status_word(c.status), c.true_rms_px, c.predicted_rms_px, ending_name(c.ending));
    if (!c.reason.empty()) text += fmt::format("    verdict: {}\n", c.reason);
    for (const std::string& flag : c.flags) text += fmt::format("    pictures: {}\n", flag);
  }
  return text;
}

}  // namespace laterna
