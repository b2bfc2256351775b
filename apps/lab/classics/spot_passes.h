// The book's spotlight as a fragment's light in a pass, by textures or exactly.
#pragma once

#include "apps/lab/classics/passes.h"
#include "render/classic/attenuation_texture.h"
#include "render/classic/intensity_map.h"

namespace laterna {

struct SpotOptions {
  int map_texels = 256;    ///< of the intensity map, each way; 0: the cone itself, no map
  int volume_texels = 32;  ///< of the attenuation texture, each way; 0: the law itself
  DepthIndex index = DepthIndex::hyperbolic;
  FragmentTests tests{};
  Wrap wrap = Wrap::clamp_to_edge;
};

/// Cone × attenuation where the projector is on the fragment's front side: 1 is the light of a point on the
/// axis at 1 m. Without a map, fragments outside the picture are killed whatever `tests` say.
LightShade spot_shade(const Fragments& fragments, const Projector& projector, const SpotOptions& options);

/// The same at a point of the world, exactly, without regard to faces and to the picture's edges; 0 behind.
double spot_at(const Projector& projector, const glm::dvec3& x_world);

}  // namespace laterna
