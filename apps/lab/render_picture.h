// One picture of a scene: a photograph, its dual, or a photograph on the mesh's own texture.
#pragma once

#include "apps/lab/simulation.h"

#include <filesystem>
#include <string>

namespace laterna {

/// The names are those of `laterna render --as`.
enum class RenderKind {
  photo,  ///< what a camera takes of a projector's picture
  dual,   ///< the scene from the projector's seat, lit by the camera (Sen et al., "Dual Photography", 2005)
  bake    ///< a camera's photograph reprojected onto a mesh's texture (render/bake.h)
};

/// Throws InputError for any other word than photo, dual and bake.
RenderKind render_kind_of(const std::string& word);

struct RenderOptions {
  RenderKind kind = RenderKind::photo;
  std::string camera, projector, mesh;  ///< names; empty: the first (for a mesh, with texture coordinates)
  /// A linear grey picture. photo: what the projector shows (absent: white). dual: what the camera sends out
  /// (absent: white). bake: the photograph (absent: the one that `photo` takes).
  std::filesystem::path show;
  int texture_px = 1024;
  int samples_per_pixel = 0;  ///< 0: the scene's; a dual takes at least 16, so that no panel pixel is missed
  std::uint64_t seed = 1;
};

/// Renders into `target`; timing is off, since one picture has no neighbours. A float format (EXR) holds
/// numbers: photo luminance in cd/m², dual Aᵀ·y in cd/m² (the sum over camera pixels y in [0, 1]), bake what
/// the photograph holds. Others hold the photograph as the camera's sensor exposes it, and dual and bake in 8
/// bits so that the 99.9th percentile of what is not black stands at 80 % of the scale. A bake's EXR has a
/// second channel, 1 where covered. Throws InputError for a name that the scene does not have, a picture of
/// the wrong size, or a target that cannot be written.
void render_picture(const Scene& scene, const RenderOptions& options, const std::filesystem::path& target,
                    StageTimes& times);

}  // namespace laterna
