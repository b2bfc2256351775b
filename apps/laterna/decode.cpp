#include "apps/laterna/pattern_words.h"

#include "apps/lab/decode_folder.h"
#include "calib/decode_quality.h"
#include "sim/error.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace laterna {

namespace {

// NaN where too little was decoded to say.
double residual_px(const DecodedMap& map) {
  try {
    return median_local_residual_px(map);
  } catch (const Refusal&) {
    return std::nan("");
  }
}

nlohmann::json rejected_json(const DecodeReport& report) {
  nlohmann::json json;
  for (int reason = 1; reason < reject_reasons; ++reason)
    json[reject_name(Reject(reason))] = report.percent[reason];
  return json;
}

void print_report(const DecodeReport& report) {
  fmt::print("  the camera sees the picture {}; rejected, %:", orientation_words(report.orientation));
  for (int reason = 1; reason < reject_reasons; ++reason)
    if (report.percent[reason] > 0)
      fmt::print(" {} {:.2f}", reject_name(Reject(reason)), report.percent[reason]);
  fmt::print("\n");
  for (const std::string& flag : report.flags) fmt::print("  {}\n", flag);
}

}  // namespace

void add_decode(CLI::App& app, Common& common) {
  struct Words {
    std::string folder, size, out;
    PatternParameters patterns;
    DecodeOptions options;
  };
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(app, "decode", "laterna decode capture -o decoded",
                                  "Decodes the pictures of a capture folder, or of a folder of real pictures "
                                  "(--projector-size), to the projector pixel that\n"
                                  "lit each camera pixel: one multi-layer EXR for each sequence.");
  command->add_option("FOLDER", words->folder, "Capture folder, or a folder of pictures")->required();
  command->add_option("--projector-size", words->size, "WIDTHxHEIGHT, for a folder without a manifest");
  add_pattern_words(*command, words->patterns);
  command->add_option("-o,--output", words->out, "New folder for the maps (default: none written)");
  command
      ->add_option("--min-contrast", words->options.gray.min_white_minus_black_dn,
                   "White minus black above this, DN of 255")
      ->capture_default_str();
  command
      ->add_option("--min-difference", words->options.gray.min_pair_difference_dn,
                   "|pattern - inverse| at least this, DN of 255")
      ->capture_default_str();
  command->add_flag("--subpixel", words->options.gray.subpixel,
                    "Gray and XOR codes: places between pixels, from where pattern and inverse cross");
  command->callback([words, &common] {
    words->options.phase.min_white_minus_black_dn = words->options.gray.min_white_minus_black_dn;
    const CaptureManifest manifest =
        manifest_or_pictures(words->folder, plain_patterns(words->patterns, words->size));
    std::optional<PendingFolder> folder;
    if (!words->out.empty()) folder.emplace(words->out);
    auto sequences = nlohmann::json::array();
    for (const CaptureSequence& sequence : manifest.sequences) {
      const DecodedSequence decoded = decode_sequence(words->folder, sequence, words->options);
      const double residual = residual_px(decoded.map);
      sequences.push_back({{"camera", sequence.camera},
                           {"projector", sequence.projector},
                           {"valid_percent", valid_percent(decoded.map)},
                           {"median_local_residual_px",
                            std::isfinite(residual) ? nlohmann::json(residual) : nlohmann::json(nullptr)},
                           {"rejected_percent", rejected_json(decoded.report)},
                           {"orientation", orientation_words(decoded.report.orientation)},
                           {"flags", decoded.report.flags}});
      if (folder)
        write_decoded(folder->path() / fmt::format("{}_{}.exr", sequence.camera, sequence.projector),
                      decoded.map);
      if (!common.json) {
        fmt::print("\"{}\" by \"{}\": {:.1f} % of the pixels decoded, median local residual {:.3f} px\n",
                   sequence.projector, sequence.camera, valid_percent(decoded.map), residual);
        print_report(decoded.report);
      }
    }
    if (folder) folder->commit();
    if (common.json) fmt::print("{}\n", nlohmann::json{{"sequences", sequences}}.dump());
    if (folder && !common.json) fmt::print("open {}\n", words->out);
  });
}

}  // namespace laterna
