// Pictures that a scene's entries name as maps: albedo, displacement, vignetting, normals, slides.
#pragma once

#include "sim/image.h"
#include "sim/image_file.h"
#include "sim/scene.h"
#include "sim/scene_spec.h"

#include <filesystem>
#include <memory>
#include <vector>

namespace laterna {

/// One value in [0, 1] per pixel. Each reader throws InputError as read_grey_float does (image_file.h), and,
/// naming the path and the value, for one outside its range.
Image<float> read_fractions(const std::filesystem::path& path, Encoding encoding);

/// Tangent-space normals as (n + 1)/2: x and y in [0, 1], z in (0.5, 1], since a normal along or below the
/// surface is none.
Image<glm::vec3> read_normals(const std::filesystem::path& path);

/// A picture that a projector shows, in grey, and in primaries where it has colour.
Slide read_slide(const PatternsSpec& patterns, const std::filesystem::path& path);
std::vector<Slide> read_slides(const PatternsSpec& patterns, const std::filesystem::path& folder);

/// Nothing where the model is no map.
std::shared_ptr<const Image<float>> vignetting_map(const Vignetting& vignetting,
                                                   const std::filesystem::path& folder);

}  // namespace laterna
