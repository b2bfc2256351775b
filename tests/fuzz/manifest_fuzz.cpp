// A manifest that is accepted is written and read back.
#include "sim/capture_folder.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    const std::string text =
        manifest_json(parse_manifest(std::string(fuzz::text_of(bytes, count)), "manifest.json"));
    fuzz::expect(manifest_json(parse_manifest(text, "again.json")) == text, "write(parse(text)) is the text");
  });
}
