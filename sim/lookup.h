// How a picture is read between and beyond its pixel centres.
#pragma once

namespace laterna {

enum class Lookup { nearest, bilinear };  ///< nearest: a panel pixel is a box
enum class Border { black, clamp };       ///< beyond the picture's edge: no light, or the edge texel's

}  // namespace laterna
