// The classics of the shipped folder, each made once for all tests of a program.
#pragma once

#include "apps/lab/classics/classics.h"
#include "tests/testing.h"

#include <map>
#include <string>

namespace laterna::testing {

inline std::filesystem::path classics_folder() { return data_folder() / "classics"; }

/// Every classic's result, made at the first call.
inline const std::vector<MadeClassic>& made_classics() {
  static const std::vector<MadeClassic> made = make_classics(find_classics({}), classics_folder());
  return made;
}

/// One classic's result, made at the first call for it: a test is a process of its own, and most need but
/// one.
inline const ClassicResult& made_classic(const std::string& name) {
  static std::map<std::string, ClassicResult> made;
  const auto [at, is_new] = made.try_emplace(name);
  if (is_new) at->second = make_classics(find_classics({name}), classics_folder()).at(0).result;
  return at->second;
}

}  // namespace laterna::testing
