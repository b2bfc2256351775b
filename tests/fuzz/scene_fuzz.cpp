// A scene that is accepted is written and read back the same.
#include "sim/scene_file.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    const SceneSpec spec = parse_scene(fuzz::text_of(bytes, count), "fuzz.toml");
    fuzz::expect(parse_scene(scene_toml(spec), "again.toml") == spec, "parse(write(scene)) is the scene");
  });
}
