#include "render/effects/camera_show.h"

#include "render/effects/apply_effects.h"
#include "render/effects/camera_glare.h"
#include "render/effects/colour.h"
#include "render/effects/scaler.h"
#include "render/effects/slide.h"
#include "render/effects/timing.h"

#include <tuple>
#include <utility>

namespace laterna {

namespace {

// The panel's pictures of each primary, or of all of them together; whether as bit planes.
std::pair<std::vector<PatternStack>, bool> panel_stacks(const Scene& scene, const Projector& projector) {
  std::vector<PatternStack> stacks;
  if (patterns_have_colour(scene))
    stacks = make_slide_primaries(shown_slides(scene), input_size(scene.effects, projector));
  else
    stacks = {make_input_patterns(scene, projector)};
  for (PatternStack& stack : stacks) apply_panel_effects(stack, scene, projector);
  const bool planes = scene.effects.timing && scene.timing.bit_planes && has_greys(stacks);
  for (PatternStack& stack : stacks) {
    if (planes) stack = bit_planes(stack);
    apply_black_and_glare(stack, scene, projector);
  }
  return {std::move(stacks), planes};
}

void add_camera_glare(CameraShow& show, double glare, const Projector& projector) {
  const MeanLight mean = mean_light_of(show.rows, projector.lookup, projector.device.intrinsics.size);
  const std::size_t stacks = show.values.size();
  for (std::size_t i = 0; i < stacks; ++i) show.values.push_back(veil_of(mean, show.values[i]));
  show.rows = apply_camera_glare(show.rows, mean, glare);
}

}  // namespace

Show CameraShow::show() const {
  std::vector<AnyPatterns> sources;
  for (const PatternStack& stack : values) sources.insert(sources.end(), sources_per_stack, stack);
  for (const BinaryPatternStack& stack : bits) sources.insert(sources.end(), sources_per_stack, stack);
  return Show(std::move(sources), timeline);
}

CameraShow make_camera_show(const Scene& scene, int camera, int projector, const ImageRows& rows) {
  const Effects& on = scene.effects;
  const Projector& source = scene.projectors[projector];
  const double glare = on.camera_glare ? scene.cameras[camera].veiling_glare : 0;
  const bool coloured = patterns_have_colour(scene), wheel = on.timing && scene.timing.colour_wheel;
  CameraShow show{rows, {}, {}};
  bool planes = false;
  const PatternSequence sequence = pattern_sequence(scene, source);
  if (source.lookup == Lookup::nearest && !edits_patterns(on) && glare == 0 && is_binary(sequence))
    show.bits = {make_binary_pattern_stack(sequence)};
  else
    std::tie(show.values, planes) = panel_stacks(scene, source);
  if (on.timing) {
    const int frames = show.values.empty() ? show.bits[0].count : show.values[0].count;
    show.timeline =
        make_timeline(scene.timing, planes ? frames / bit_plane_count : frames, rows.size.y, planes);
  }
  if (glare > 0) add_camera_glare(show, glare, source);
  show.sources_per_stack = wheel && !coloured ? 3 : 1;
  show.rows.rows = apply_colour(show.rows.rows, scene, camera, projector, coloured || wheel);
  return show;
}

}  // namespace laterna
