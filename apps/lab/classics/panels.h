// Light as pictures for the eye, and several of them side by side.
#pragma once

#include "apps/lab/canvas.h"
#include "sim/image.h"

#include <string>
#include <vector>

namespace laterna {

/// Linear light in grey, encoded with the sRGB curve (IEC 61966-2-1); `white` and above is 255. Throws
/// InputError unless `white` is above 0.
Canvas grey_canvas(const Image<float>& light, double white);

/// The same in colour: red, green and blue light, each of the same size.
Canvas colour_canvas(const Image<glm::vec3>& light, double white);

/// A value at each pixel in the viridis map, `least` dark and `most` bright; black where it is not finite.
Canvas map_canvas(const Image<float>& values, double least, double most);

struct Panel {
  std::string caption;
  Canvas canvas;
};

/// Panels of one size in rows of `columns`, each under its caption.
Canvas side_by_side(const std::vector<Panel>& panels, int columns);

}  // namespace laterna
