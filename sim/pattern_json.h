// A pattern family as JSON, with the keys of a scene file's [patterns].
#pragma once

#include "sim/pattern_sequence.h"

#include <nlohmann/json_fwd.hpp>

namespace laterna {

/// "gray", or an object with `kind` and whatever differs from the default.
nlohmann::json patterns_json(const PatternParameters& patterns);

/// The inverse. Throws InputError, beginning with "patterns: ", for an unknown family or key, a value of
/// another type or out of its range.
PatternParameters patterns_of(const nlohmann::json& json);

}  // namespace laterna
