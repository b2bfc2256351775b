// A capture folder's pictures to decoded maps: simulated and real ones alike.
#pragma once

#include "calib/decode.h"
#include "calib/decode_report.h"
#include "sim/capture_folder.h"
#include "sim/image_file.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace laterna {

/// One sequence of a folder.
struct DecodedSequence {
  CaptureSequence sequence;
  DecodedMap map;
  DecodeReport report;
};

/// The folder's manifest; where there is none and `patterns` is given, all its pictures as one
/// sequence of that family. Throws InputError where there is neither.
CaptureManifest manifest_or_pictures(const std::filesystem::path& folder,
                                     const std::optional<PatternSequence>& patterns);

/// Reads and decodes one sequence. Throws InputError where pictures are missing or unreadable, or their
/// number is not that of the patterns.
DecodedSequence decode_sequence(const std::filesystem::path& folder, const CaptureSequence& sequence,
                                const DecodeOptions& options);

/// The same for pictures at hand.
DecodedSequence decode_sequence(const std::filesystem::path& folder, const CaptureSequence& sequence,
                                const CapturedStack& pictures, const DecodeOptions& options);

/// Layers projector.u, projector.v (px), sigma.px, confidence, valid, in single precision. The header carries
/// the camera where it is known.
void write_decoded(const std::filesystem::path& path, const DecodedMap& map,
                   const PictureCamera& camera = {});

/// Share of valid pixels, in per cent.
double valid_percent(const DecodedMap& map);

}  // namespace laterna
