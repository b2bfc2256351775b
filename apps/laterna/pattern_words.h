// The pattern family as words of the command line, shared by patterns, decode and calibrate.
#pragma once

#include "apps/laterna/command.h"
#include "sim/pattern_sequence.h"

#include <optional>

namespace laterna {

/// Adds --kind, --steps, --pitch-px, --pitches-px, --xor-stripe-px, --square-px and --repeat-first, with the
/// ranges of a scene file's [patterns]; the parameters are set when the command line is parsed.
void add_pattern_words(CLI::App& command, PatternParameters& patterns);

/// The family for a folder of plain pictures; empty where --projector-size is.
std::optional<PatternSequence> plain_patterns(const PatternParameters& patterns, const std::string& size);

}  // namespace laterna
