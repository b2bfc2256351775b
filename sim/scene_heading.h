// How messages name a scene's entries.
#pragma once

#include "sim/error.h"

#include <string>
#include <utility>

namespace laterna {

/// `[[kind]] "name"`, or `[[kind]]` where it has no name.
inline std::string heading(const std::string& kind, const std::string& name) {
  return "[[" + kind + "]]" + (name.empty() ? "" : " \"" + name + "\"");
}

/// Runs `action`; an InputError gets `what` in front.
template <class Action>
auto about(const std::string& what, Action&& action) {
  try {
    return std::forward<Action>(action)();
  } catch (const InputError& error) {
    throw InputError(what + ": " + error.what());
  }
}

}  // namespace laterna
