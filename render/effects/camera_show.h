// What one camera sees a projector play: rows, patterns and timing together. Stage: replay.
//
// Patterns: scaler and response, then bit planes, then black level and veiling glare. Rows of white light:
// camera glare, then colour. Last the timeline, which mixes frames into pictures.
#pragma once

#include "render/image_rows.h"
#include "render/show.h"
#include "sim/scene.h"

#include <vector>

namespace laterna {

/// Rows that are ready to play, and the stacks that their sources play.
struct CameraShow {
  ImageRows rows;
  std::vector<PatternStack> values;      ///< of patterns, one or one per primary; then of camera glare alike
  std::vector<BinaryPatternStack> bits;  ///< in place of them where all is black and white
  int sources_per_stack = 1;             ///< 3 where primaries play the same at different times
  Timeline timeline{};

  /// Points to this object's stacks.
  Show show() const;
};

/// `rows` are of white light, from one source. Throws InputError where the slide is not of the projector's
/// size, or timing speaks of pictures that are none.
CameraShow make_camera_show(const Scene& scene, int camera, int projector, const ImageRows& rows);

}  // namespace laterna
