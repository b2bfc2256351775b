#include "apps/lab/trial_report.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] { read_estimates(fuzz::file_with(fuzz::text_of(bytes, count), ".json")); });
}
