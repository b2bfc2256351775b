// A capture folder's pictures to decoded maps: simulated and real ones alike.
#pragma once

#include "calib/decode_gray.h"
#include "sim/capture_folder.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace laterna {

/// One sequence of a folder.
struct DecodedSequence {
  CaptureSequence sequence;
  DecodedMap map;
};

/// The folder's manifest; where there is none and `projector_size` is given, all its pictures as one
/// sequence. Throws InputError where there is neither.
CaptureManifest manifest_or_pictures(const std::filesystem::path& folder,
                                     std::optional<glm::ivec2> projector_size);

/// Reads and decodes one sequence. Throws InputError where pictures are missing or unreadable, or their
/// number is not that of the patterns.
DecodedSequence decode_sequence(const std::filesystem::path& folder, const CaptureSequence& sequence,
                                const GrayDecodeOptions& options);

/// Layers projector.u, projector.v (px), sigma.px, confidence, valid, in single precision.
void write_decoded(const std::filesystem::path& path, const DecodedMap& map);

/// Share of valid pixels, in per cent.
double valid_percent(const DecodedMap& map);

}  // namespace laterna
