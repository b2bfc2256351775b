// The two ways in which Laterna says no.
#pragma once

#include <stdexcept>

namespace laterna {

/// Bad input. The message is one sentence: file, key or line; what was found; what was expected. The command
/// exits with 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Sound input that cannot answer the question ("all points lie in one plane"). The message is the reason;
/// the command exits with 3.
struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace laterna
