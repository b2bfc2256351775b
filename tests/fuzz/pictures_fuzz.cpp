// The first byte chooses the ending, the others are the file: a sequence of one file, whose pages are its
// pictures.
#include "sim/image_file.h"
#include "tests/fuzz/fuzz.h"

#include <array>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  if (count == 0) return 0;
  constexpr std::array<const char*, 4> endings = {".png", ".tif", ".pgm", ".exr"};
  return fuzz::attempt([&] {
    read_stack({fuzz::file_with(fuzz::text_of(bytes + 1, count - 1), endings[bytes[0] % endings.size()])});
  });
}
