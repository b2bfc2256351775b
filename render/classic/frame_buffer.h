// A frame buffer as multi-pass rendering knows it: colour, depth, and passes that compare and blend.
#pragma once

#include "render/surface.h"
#include "sim/image.h"

#include <cmath>
#include <limits>
#include <optional>

namespace laterna {

enum class DepthTest { less, equal };
enum class Blend { keep, replace, add, multiply };

/// How a pass treats what is there.
struct Pass {
  DepthTest depth_test = DepthTest::less;  ///< `less` writes the depth, `equal` does not
  Blend blend = Blend::replace;            ///< keep: depth only
};

struct FrameBuffer {
  Image<double> colour;  ///< 0 where nothing was drawn
  Image<double> depth;   ///< infinite where nothing was drawn
  int steps = 0;         ///< 0: exact numbers; 255: 8 bits, 0 to 1, rounded and clamped after every pass

  FrameBuffer(int width, int height, int colour_steps = 0)
      : colour(width, height, 0.0), depth(width, height, infinite), steps(colour_steps) {}
  void clear_depth() { depth = Image<double>(depth.width, depth.height, infinite); }

  static constexpr double infinite = std::numeric_limits<double>::infinity();
};

inline double stored(const FrameBuffer& buffer, double colour) {
  if (buffer.steps == 0) return colour;
  return std::round(std::clamp(colour, 0.0, 1.0) * buffer.steps) / buffer.steps;
}

/// Draws one object's fragments, a map of what the camera would see of it alone. shade(p) is the colour of
/// fragment p, a std::optional<double>: empty where it is killed, before it leaves colour or depth.
template <class Shade>
void draw(FrameBuffer& buffer, const SurfaceMap& fragments, const Pass& pass, const Shade& shade) {
  for (std::size_t p = 0; p < buffer.depth.values.size(); ++p) {
    if (!fragments.hit(p)) continue;
    const double depth = fragments.depth_m.values[p];
    double& there = buffer.depth.values[p];
    if (pass.depth_test == DepthTest::less ? !(depth < there) : depth != there) continue;
    const std::optional<double> colour = shade(p);
    if (!colour) continue;
    there = depth;
    double& under = buffer.colour.values[p];
    if (pass.blend == Blend::replace) under = stored(buffer, *colour);
    if (pass.blend == Blend::add) under = stored(buffer, under + *colour);
    if (pass.blend == Blend::multiply) under = stored(buffer, under * *colour);
  }
}

}  // namespace laterna
