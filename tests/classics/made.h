// The classics of the shipped folder, each made once for all tests of a program.
#pragma once

#include "apps/lab/classics/classics.h"
#include "tests/testing.h"

namespace laterna::testing {

inline std::filesystem::path classics_folder() { return data_folder() / "classics"; }

/// Every classic's result, made at the first call.
inline const std::vector<MadeClassic>& made_classics() {
  static const std::vector<MadeClassic> made = make_classics(find_classics({}), classics_folder());
  return made;
}

inline const ClassicResult& made_classic(const std::string& name) {
  for (const MadeClassic& one : made_classics())
    if (one.classic.name == name) return one.result;
  throw std::logic_error("no classic is called " + name);
}

}  // namespace laterna::testing
