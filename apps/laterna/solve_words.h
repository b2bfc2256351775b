// The solver's options as words of the command line, shared by calibrate and roundtrip.
#pragma once

#include "apps/laterna/command.h"

#include "calib/solve.h"

namespace laterna {

/// Adds --tolerance-px, --loss and --loss-scale; the options are set when the command line is parsed.
void add_solve_words(CLI::App& command, SolveOptions& options);

}  // namespace laterna
