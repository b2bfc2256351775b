// The documentation of the scene file, made from its description.
#pragma once

#include <string>

namespace laterna {

/// A page of Markdown with one table for each noun: key, unit, value, default, meaning.
/// data/scene-reference.md is this text.
std::string scene_reference_markdown();

}  // namespace laterna
