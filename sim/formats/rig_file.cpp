#include "sim/formats/rig_file.h"

#include "sim/error.h"
#include "sim/plain_name.h"
#include "sim/safe_write.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace laterna {

namespace {

namespace fs = std::filesystem;

std::string names_of_formats() {
  std::string names;
  for (const RigFormat& format : rig_formats())
    names += (names.empty() ? "" : ", ") + std::string(format.name);
  return names;
}

const RigFormat& format_called(const std::string& name) {
  for (const RigFormat& format : rig_formats())
    if (name == format.name) return format;
  throw InputError(fmt::format("no format is called \"{}\", expected one of {}", name, names_of_formats()));
}

// The tree of a YAML, XML or JSON file, by its ending or without one; null for a folder and for endings of
// other languages.
Tree tree_at(const fs::path& path) {
  static const std::set<std::string> endings = {"", ".yml", ".yaml", ".xml", ".json", ".gltf"};
  if (!endings.contains(path.extension().string()) || fs::is_directory(path)) return nullptr;
  return any_tree(read_text(path, most_tree_bytes), path.string());
}

const RigFormat& format_of(const fs::path& path) {
  if (!fs::exists(path)) throw InputError(path.string() + ": no such file or folder, expected a calibration");
  const Tree tree = tree_at(path);
  for (const RigFormat& format : rig_formats())
    if (format.is(path, tree)) return format;
  throw InputError(
      fmt::format("{}: no calibration that is known, expected one of {}", path.string(), names_of_formats()));
}

void set_size(std::vector<Device>& devices, glm::ivec2 size, const char* kind) {
  for (Device& device : devices) {
    if (device.intrinsics.size.x != 0) continue;
    if (size.x == 0)
      throw InputError(fmt::format("\"{}\": the file does not say its picture's size, expected --{}-size WxH",
                                   device.name, kind));
    device.intrinsics.size = size;
  }
}

void check_rig(const Rig& rig) {
  std::set<std::string> names;
  for (const Device& device : devices_of(rig)) {
    if (device.name.empty()) throw InputError("a device without a name");
    if (!names.insert(device.name).second)
      throw InputError(fmt::format("a second device is called \"{}\"", device.name));
    validate(device);
  }
  if (names.empty()) throw InputError("holds no device, expected a calibration");
}

const RigFormat& format_to_write(const fs::path& path, const std::string& name) {
  if (!name.empty()) return format_called(name);
  for (const RigFormat& format : rig_formats())
    if (format.write && *format.ending && path.string().ends_with(format.ending)) return format;
  throw InputError(fmt::format("{}: the ending tells no format, expected --as with one of {}", path.string(),
                               names_of_formats()));
}

/// With the cameras that the projectors were solved from, where the format needs one.
Rig rig_for(const RigFormat& format, Rig rig, Notes& notes) {
  if (!format.is_pair || !rig.cameras.empty()) return rig;
  rig.cameras = rig.given_cameras;
  for (const Device& camera : rig.cameras)
    notes.push_back(fmt::format("camera \"{}\" was given, not solved for", camera.name));
  return rig;
}

}  // namespace

Rig read_rig(const fs::path& path, const RigReadOptions& options) {
  const RigFormat& format = options.format.empty() ? format_of(path) : format_called(options.format);
  if (format.fixes_unit && options.unit_m != 1)
    throw InputError(
        fmt::format("{}: {} fixes its unit of length, expected no other", path.string(), format.name));
  Rig rig = format.read(path, options);
  try {
    set_size(rig.cameras, options.camera_size, "camera");
    set_size(rig.projectors, options.projector_size, "projector");
    check_rig(rig);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path.string(), error.what()));
  }
  return scaled(std::move(rig), options.unit_m);
}

std::vector<RigText> rig_texts(const Rig& rig, const fs::path& path, const std::string& name, double unit_m,
                               Notes& notes) {
  const RigFormat& format = format_to_write(path, name);
  if (!format.write) throw InputError(fmt::format("{} is read only", format.name));
  if (format.fixes_unit && unit_m != 1)
    throw InputError(fmt::format("{} fixes its unit of length, expected no other", format.name));
  const Rig whole = rig_for(format, rig, notes);
  check_rig(whole);
  std::vector<RigText> texts = format.write(scaled(whole, 1 / unit_m), notes);
  if (*format.ending && !path.has_extension() && texts.size() == 1 && texts[0].name.empty())
    throw InputError(fmt::format("{}: {} is known by its ending, expected a name that ends in {}",
                                 path.string(), format.name, format.ending));
  return texts;
}

void write_rig(const fs::path& path, const std::vector<RigText>& texts) {
  if (texts.size() == 1 && texts[0].name.empty()) {
    write_file(path, std::string_view(texts[0].text));
    return;
  }
  PendingFolder folder(path);
  for (const RigText& text : texts) check_plain_name(text.name, path.string());
  for (const RigText& text : texts) write_file(folder.path() / text.name, std::string_view(text.text));
  folder.commit();
}

}  // namespace laterna
