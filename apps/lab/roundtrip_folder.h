// A round trip with its results in a folder: numbers, estimate, and a picture worth looking at.
#pragma once

#include "apps/lab/trial.h"

#include <filesystem>

namespace laterna {

struct RoundtripOutput {
  std::vector<ProjectorOutcome> outcomes;
  StageTimes times;
  std::vector<std::string> files;  ///< written, relative to the folder; the one to look at first
};

/// Traces, runs the trial, and where `target` is not empty leaves there: summary_<camera>_<projector>.png for
/// each view, result.json (trial_report.h), estimate.json, the decoded maps as EXR, and what `laterna report`
/// draws: figures.json (report/trial_figures.h, and "views": [{"camera", "projector", "projector_size",
/// "decoded", "frames": [{"label", "file"}]}]), live.json (live_page.h) and the pictures, small, in
/// frames/<camera>_<projector>. The folder must not exist; it is there only when complete. Throws InputError
/// as trace() and PendingFolder do.
RoundtripOutput roundtrip(const Scene& scene, const std::string& scene_name,
                          const std::filesystem::path& target, const TrialOptions& options,
                          const Progress& progress = {});

}  // namespace laterna
