// The rows of a camera's whole image, region by region.
#pragma once

#include "render/light_rows.h"

#include <functional>

namespace laterna {

/// A picture's rows, in any number of regions.
struct ImageRows {
  glm::ivec2 size{0, 0};  ///< of the camera's image
  RowSource rows;
  glm::ivec2 region_px{256, 4};  ///< what is asked for at a time; multiples of 4; no bits depend on it
};

/// How many regions the image is cut into.
std::size_t region_count(const ImageRows& image);

/// Calls work(rows, index) once for each region, on several threads; `rows` may be moved from. Throws
/// InputError where region_px is not made of multiples of 4.
void for_each_region(const ImageRows& image, const std::function<void(LightRows&, std::size_t)>& work);

/// The same for the regions first to first + count - 1.
void for_each_region(const ImageRows& image, std::size_t first, std::size_t count,
                     const std::function<void(LightRows&, std::size_t)>& work);

}  // namespace laterna
