#include "sim/instruction_sets.h"

#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <hwy/targets.h>

#include <cstdint>

namespace laterna {

namespace {

struct Set {
  const char* name;
  const char* embree;         // Embree's word
  std::int64_t best_highway;  // the widest of Highway's targets that it may use
};

#if HWY_ARCH_X86
constexpr Set sets[] = {{"sse2", "sse2", HWY_STATIC_TARGET},
                        {"sse4.2", "sse4.2", HWY_SSE4},
                        {"avx", "avx", HWY_SSE4},
                        {"avx2", "avx2", HWY_AVX2},
                        {"avx512", "avx512", HWY_AVX3}};
#elif HWY_ARCH_ARM_A64
constexpr Set sets[] = {{"neon", "", HWY_NEON}};
#else
constexpr Set sets[] = {{"scalar", "", HWY_STATIC_TARGET}};
#endif

const Set*& cap() {
  static const Set* chosen = nullptr;
  return chosen;
}

}  // namespace

std::vector<std::string> instruction_set_names() {
  std::vector<std::string> names;
  for (const Set& set : sets) names.emplace_back(set.name);
  return names;
}

void cap_instruction_set(const std::string& name) {
  const Set* found = nullptr;
  for (const Set& set : sets)
    if (name == set.name) found = &set;
  if (!found && !name.empty())
    throw InputError(fmt::format("instruction set: \"{}\" was found, expected one of {}", name,
                                 fmt::join(instruction_set_names(), ", ")));
  cap() = found;
  hwy::DisableTargets(found ? found->best_highway - 1 : 0);  // the better a target, the lower its bit
}

std::string instruction_set() {
  const std::int64_t usable = hwy::SupportedTargets() & HWY_TARGETS, best = usable & -usable;
  std::string name = sets[0].name;
  for (const Set& set : sets)
    if (std::string(set.name) != "avx" && set.best_highway == best) name = set.name;
  return name;
}

std::string embree_configuration() {
  std::string words;
  if (cap() && *cap()->embree) words = fmt::format("max_isa={},", cap()->embree);
#ifdef LATERNA_PLAIN_THREADS
  words += "threads=1";  // Debian's Embree is not instrumented: ThreadSanitizer cannot follow its threads
#endif
  return words;
}

}  // namespace laterna
