// A device that is accepted is written and read back.
#include "sim/cameramodel_file.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    const Device device = parse_cameramodel(std::string(fuzz::text_of(bytes, count)), "fuzz.cameramodel");
    const Device again = parse_cameramodel(cameramodel_text(device), "again.cameramodel");
    fuzz::expect(again.intrinsics.fx == device.intrinsics.fx && again.lens == device.lens,
                 "intrinsics and lens come back exactly");
  });
}
