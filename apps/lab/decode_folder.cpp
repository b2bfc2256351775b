#include "apps/lab/decode_folder.h"

#include "sim/error.h"
#include "sim/image_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace laterna {

namespace {

/// Throws where a size is asked for that is not the manifest's.
CaptureManifest manifest_of(const std::filesystem::path& folder,
                            const std::optional<PatternSequence>& patterns) {
  CaptureManifest manifest = read_manifest(folder);
  for (const CaptureSequence& sequence : manifest.sequences)
    if (patterns && patterns->projector_size != sequence.projector_size)
      throw InputError(fmt::format(
          "--projector-size: found {}x{}, but {} says {}x{}, expected that or no such option",
          patterns->projector_size.x, patterns->projector_size.y, (folder / "manifest.json").string(),
          sequence.projector_size.x, sequence.projector_size.y));
  return manifest;
}

}  // namespace

CaptureManifest manifest_or_pictures(const std::filesystem::path& folder,
                                     const std::optional<PatternSequence>& patterns) {
  if (!std::filesystem::is_directory(folder))
    throw InputError(folder.string() + ": no such folder, expected one of pictures");
  if (std::filesystem::exists(folder / "manifest.json")) return manifest_of(folder, patterns);
  if (!patterns) {
    throw InputError(fmt::format(
        "{}: no manifest.json, expected a capture folder, or --projector-size for a folder of pictures",
        folder.string()));
  }
  CaptureManifest manifest;
  manifest.sequences.push_back(plain_sequence(folder, *patterns));
  return manifest;
}

namespace {

// Runs `action`; an InputError that does not name the folder gets it in front.
template <class Action>
auto in_folder(const std::filesystem::path& folder, Action&& action) {
  try {
    return action();
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (message.find(folder.string()) != std::string::npos) throw;
    throw InputError(fmt::format("{}: {}", folder.string(), message));
  }
}

}  // namespace

DecodedSequence decode_sequence(const std::filesystem::path& folder, const CaptureSequence& sequence,
                                const CapturedStack& pictures, const DecodeOptions& options) {
  return in_folder(folder, [&] {
    const PatternSequence patterns{sequence.patterns, sequence.projector_size};
    DecodedSequence decoded{sequence, decode(pictures, patterns, options), {}};
    decoded.report = report_on(pictures, patterns, decoded.map);
    return decoded;
  });
}

DecodedSequence decode_sequence(const std::filesystem::path& folder, const CaptureSequence& sequence,
                                const DecodeOptions& options) {
  return decode_sequence(folder, sequence, in_folder(folder, [&] { return read_pictures(folder, sequence); }),
                         options);
}

void write_decoded(const std::filesystem::path& path, const DecodedMap& map, const PictureCamera& camera) {
  const std::vector<std::string> names{"projector.u", "projector.v", "sigma.px", "confidence", "valid"};
  std::vector<float> data;
  data.reserve(map.valid.values.size() * names.size());
  for (std::size_t i = 0; i < map.valid.values.size(); ++i) {
    data.insert(data.end(), {float(map.u_px.values[i]), float(map.v_px.values[i]), map.sigma_px.values[i],
                             map.confidence.values[i], float(map.valid.values[i])});
  }
  write_picture(path, {data.data(), map.width, map.height, int(names.size()), PixelType::f32, names, camera});
}

double valid_percent(const DecodedMap& map) {
  const auto valid = std::count(map.valid.values.begin(), map.valid.values.end(), std::uint8_t{1});
  return map.valid.values.empty() ? 0 : 100.0 * double(valid) / double(map.valid.values.size());
}

}  // namespace laterna
