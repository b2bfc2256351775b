// Calibration files of whatever kind, as one value: what `laterna convert` and `laterna score` read.
//
// One header per format beside this one says what its convention is and how it becomes ours (rig.h).
#pragma once

#include "sim/formats/parts.h"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace laterna {

/// What a file does not say itself.
struct RigReadOptions {
  std::string format{};             ///< a name of rig_formats(); empty: by content and ending
  double unit_m = 1;                ///< metres in one unit, of formats that do not fix it
  glm::ivec2 camera_size{0, 0};     ///< pictures' size of cameras whose file does not say it
  glm::ivec2 projector_size{0, 0};  ///< likewise
};

/// One text that a format consists of. A format of one file leaves `name` empty.
struct RigText {
  std::string name, text;
};

/// A format: how it is called, recognised, read and written.
struct RigFormat {
  const char* name;
  const char* ending;    ///< of a file, with its dot; empty: a folder
  const char* sentence;  ///< for --help
  bool fixes_unit;       ///< lengths are in metres, millimetres or in what the file says
  bool (*is)(const std::filesystem::path& path, const Tree& tree);  ///< tree: null where the file is none
  Rig (*read)(const std::filesystem::path& path, const RigReadOptions& options);
  std::vector<RigText> (*write)(const Rig& rig, Notes& notes);  ///< null: read only
  bool is_pair =
      false;  ///< holds one camera and one projector: a rig without cameras gives its given_cameras
};

/// All of them; of several that recognise a file the first counts, and of several with an ending the first is
/// written.
std::span<const RigFormat> rig_formats();

/// Reads a calibration of any format, a folder of .cameramodel or camera_info files (each a device,
/// projectors those whose names begin with "proj"), or the scene of a capture folder. Every device is sound
/// (sim/device.h: validate). Throws InputError, beginning with the path, where it cannot be read, is of no
/// known format, two devices share a name, a picture's size is said neither by the file nor by the options,
/// or a unit is given for a format that fixes its own.
Rig read_rig(const std::filesystem::path& path, const RigReadOptions& options = {});

/// The texts of a rig in a format, by name, or by the ending of `path` where `format` is empty; lengths in
/// units of `unit_m` metres. What the format cannot hold is an InputError or a note, and so is a path without
/// an ending for a file that is known by it.
std::vector<RigText> rig_texts(const Rig& rig, const std::filesystem::path& path, const std::string& format,
                               double unit_m, Notes& notes);

/// Writes them: a file, whole or not at all, or a new folder (sim/safe_write.h).
void write_rig(const std::filesystem::path& path, const std::vector<RigText>& texts);

}  // namespace laterna
