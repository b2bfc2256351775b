// Calibration files of other tools. The first byte chooses the ending, the others are the file; of COLMAP's
// folder, its two files with a zero byte between them. A rig that is accepted is written as OpenCV's storage.
#include "sim/formats/rig_file.h"
#include "tests/fuzz/fuzz.h"

#include <algorithm>
#include <array>

namespace {

using namespace laterna;

std::filesystem::path colmap_folder(std::string_view bytes) {
  const std::filesystem::path folder = fuzz::scratch() / "colmap";
  std::filesystem::create_directories(folder);
  const std::size_t middle = std::min(bytes.find('\0'), bytes.size());
  const auto put = [&](const char* name, std::string_view text) {
    std::filesystem::rename(fuzz::file_with(text, ".part"), folder / name);
  };
  put("cameras.txt", bytes.substr(0, middle));
  put("images.txt", bytes.substr(std::min(middle + 1, bytes.size())));
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  if (count == 0) return 0;
  constexpr std::array<const char*, 8> endings = {".yaml", ".xml",         ".json", ".gltf",
                                                  ".usda", ".cameramodel", ".toml", ".exr"};
  const std::string_view text = fuzz::text_of(bytes + 1, count - 1);
  const std::size_t which = bytes[0] % (endings.size() + 1);
  RigReadOptions options;
  options.camera_size = options.projector_size = {640, 480};
  return fuzz::attempt([&] {
    const Rig rig = read_rig(
        which < endings.size() ? fuzz::file_with(text, endings[which]) : colmap_folder(text), options);
    Notes notes;
    rig_texts(rig, "rig.yaml", "opencv", 1, notes);
  });
}
