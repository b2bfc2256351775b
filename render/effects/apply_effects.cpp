#include "render/effects/apply_effects.h"

#include "render/effects/attenuation.h"
#include "render/effects/gloss.h"
#include "render/effects/normal_map.h"
#include "render/effects/projector_defocus.h"
#include "render/effects/response.h"
#include "render/effects/scaler.h"
#include "render/effects/slide.h"
#include "render/effects/solid_albedo.h"
#include "render/effects/spotlight.h"
#include "render/effects/veiling_glare.h"
#include "render/effects/vignetting.h"
#include "sim/error.h"

#include <fmt/format.h>

namespace laterna {

void apply_effects(SurfaceMap& surface, std::span<LightMap> lights, const RayScene& rays, const Scene& scene,
                   const Camera& camera) {
  if (lights.size() != scene.projectors.size()) {
    throw InputError(fmt::format("effects: light of {} projectors, expected the scene's {}", lights.size(),
                                 scene.projectors.size()));
  }
  apply_surface_effects(surface, scene);
  for (std::size_t i = 0; i < lights.size(); ++i)
    apply_light_effects(lights[i], surface, rays, scene, scene.projectors[i], camera);
  apply_camera_effects(surface, rays, scene, camera);
}

void apply_surface_effects(SurfaceMap& surface, const Scene& scene) {
  if (scene.effects.solid_albedo) apply_solid_albedo(surface, scene);
  if (scene.effects.gloss) make_room_for_gloss(surface, scene);
}

namespace {

// `camera`: who looks; null: nobody in particular.
void weigh_light(LightMap& light, const SurfaceMap& surface, const RayScene& rays, const Scene& scene,
                 const Projector& projector, const Camera* camera) {
  const Effects& on = scene.effects;
  const PixelGeometry geometry(surface, rays, scene);
  if (on.normal_map && on.irradiance) apply_normal_map(light, geometry, projector);
  if (on.gloss && camera) apply_gloss(light, geometry, projector, *camera);
  if (on.attenuation) apply_attenuation(light, geometry, projector);
  if (on.spotlight) apply_spotlight(light, geometry, projector);
  if (on.projector_vignetting) apply_projector_vignetting(light, geometry, projector);
  if (on.projector_defocus) apply_projector_defocus(light, geometry, projector);
}

}  // namespace

void apply_light_effects(LightMap& light, const SurfaceMap& surface, const RayScene& rays, const Scene& scene,
                         const Projector& projector, const Camera& camera) {
  weigh_light(light, surface, rays, scene, projector, &camera);
}

void apply_light_effects(LightMap& light, const SurfaceMap& surface, const RayScene& rays, const Scene& scene,
                         const Projector& projector) {
  weigh_light(light, surface, rays, scene, projector, nullptr);
}

void apply_camera_effects(SurfaceMap& surface, const RayScene& rays, const Scene& scene,
                          const Camera& camera) {
  if (!scene.effects.camera_vignetting) return;
  apply_camera_vignetting(surface, PixelGeometry(surface, rays, scene), camera);
}

void apply_panel_effects(PatternStack& patterns, const Scene& scene, const Projector& projector) {
  const Scaler& scaler = projector.effects.scaler;
  if (scene.effects.scaler && !(scaler == Scaler{}))
    patterns = scale_patterns(patterns, scaler, projector.device.intrinsics.size);
  if (scene.effects.response) apply_response(patterns, projector.effects);
}

void apply_black_and_glare(PatternStack& patterns, const Scene& scene, const Projector& projector) {
  if (scene.effects.black_level) apply_black_level(patterns, projector.effects);
  if (scene.effects.veiling_glare) apply_veiling_glare(patterns, projector.effects);
}

void apply_effects(PatternStack& patterns, const Scene& scene, const Projector& projector) {
  apply_panel_effects(patterns, scene, projector);
  apply_black_and_glare(patterns, scene, projector);
}

PatternStack make_input_patterns(const Scene& scene, const Projector& projector) {
  const std::span<const Slide> slides = shown_slides(scene);
  return slides.empty() ? make_pattern_stack(pattern_sequence(scene, projector))
                        : make_slide_stack(slides, input_size(scene.effects, projector));
}

PatternSequence pattern_sequence(const Scene& scene, const Projector& projector) {
  return {scene.patterns, input_size(scene.effects, projector)};
}

PatternStack make_patterns(const Scene& scene, const Projector& projector) {
  PatternStack patterns = make_input_patterns(scene, projector);
  apply_effects(patterns, scene, projector);
  return patterns;
}

}  // namespace laterna
