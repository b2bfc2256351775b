// TOML texts of the lab's own files: grids, specifications of data sets.
#pragma once

#include <toml++/toml.h>
#include <string>
#include <string_view>

namespace laterna {

/// The text's tables. Throws InputError, "FILE:LINE: what is wrong", where its bytes are refused
/// (sim/toml_guard.h) or it is no TOML.
toml::table parse_toml(std::string_view text, const std::string& file);

}  // namespace laterna
