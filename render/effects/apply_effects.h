// The effects that a scene has switched on, applied in order.
#pragma once

#include "render/direct_light.h"
#include "render/ray_scene.h"
#include "render/surface.h"
#include "sim/pattern.h"
#include "sim/pattern_sequence.h"
#include "sim/scene.h"

#include <span>

namespace laterna {

/// What edits surfaces and weights, after trace_surface and trace_light: solid albedo; for each projector's
/// light normal map, gloss, attenuation, spotlight, projector vignetting, projector defocus (footprints);
/// then camera vignetting. `lights` has one per projector of the scene, in its order, all traced from
/// `surface` as `camera` sees it. What is off leaves every bit as it was. Throws InputError where the counts
/// differ.
void apply_effects(SurfaceMap& surface, std::span<LightMap> lights, const RayScene& rays, const Scene& scene,
                   const Camera& camera);

/// The three parts of that, for maps of any region: what acts on the surface, on one projector's light, and
/// last on what the camera's lens lets through.
void apply_surface_effects(SurfaceMap& surface, const Scene& scene);
void apply_light_effects(LightMap& light, const SurfaceMap& surface, const RayScene& rays, const Scene& scene,
                         const Projector& projector, const Camera& camera);
/// The same for light that goes on diffusely, to no one camera: without gloss.
void apply_light_effects(LightMap& light, const SurfaceMap& surface, const RayScene& rays, const Scene& scene,
                         const Projector& projector);
void apply_camera_effects(SurfaceMap& surface, const RayScene& rays, const Scene& scene,
                          const Camera& camera);

/// What edits patterns: scaler (after which the stack has the panel's size), response, black level, veiling
/// glare. What is off leaves every bit as it was.
void apply_effects(PatternStack& patterns, const Scene& scene, const Projector& projector);

/// The two parts of that: the signal's way to the panel (scaler, response), and the light behind it (black
/// level, veiling glare).
void apply_panel_effects(PatternStack& patterns, const Scene& scene, const Projector& projector);
void apply_black_and_glare(PatternStack& patterns, const Scene& scene, const Projector& projector);

/// The family that the scene names, for the size that the projector takes.
PatternSequence pattern_sequence(const Scene& scene, const Projector& projector);

/// The scene's patterns as the projector's panel shows them: a sequence, slide or pictures, of input_size()
/// (render/effects/scaler.h), then apply_effects.
PatternStack make_patterns(const Scene& scene, const Projector& projector);

/// What goes into the projector, before those effects; a coloured slide as grey.
PatternStack make_input_patterns(const Scene& scene, const Projector& projector);

}  // namespace laterna
