// The OpenGL course book's spotlights: data/classics/book_spotlight.toml.
#pragma once

#include "apps/lab/classics/classic.h"

namespace laterna {

/// Source: Woo, Neider, Davis, Shreiner, "OpenGL Programming Guide"; SIGGRAPH courses on advanced OpenGL:
/// spotlights as projective textures, attenuation as a 3D texture.
ClassicResult book_spotlight(const std::filesystem::path& scenes);

}  // namespace laterna
