// The 1992 spotlight and slide-projector demo: data/classics/slide_projector.toml.
#pragma once

#include "apps/lab/classics/classic.h"

namespace laterna {

/// Source: Segal, Korobkin, van Widenfelt, Foran, Haeberli, "Fast Shadows and Lighting Effects Using Texture
/// Mapping", SIGGRAPH 1992.
ClassicResult slide_projector(const std::filesystem::path& scenes);

}  // namespace laterna
