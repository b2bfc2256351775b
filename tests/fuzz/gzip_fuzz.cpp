#include "sim/gzip.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] { gunzip(fuzz::text_of(bytes, count), "fuzz.gz"); });
}
