// What a round trip found, for machines and for people.
#pragma once

#include "apps/lab/trial.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <string>

namespace laterna {

/// {"projectors": [{"name", "status": "ok"|"weak"|"refused", "reason", "correspondences", "surface_error_px",
/// "volume_error_px", "extrapolation_error_px": {"rms", "max", "points", "predicted_rms"}, "estimate": {"fx",
/// "fy", "cx", "cy", "lens", "projector_from_world", "texture_from_world", "sigma": {...}}, "fit_rms_px",
/// ..., "seconds": {stage: s}}], "seconds": {...}}. A number that is not finite is null; errors and estimate
/// are null where refused.
nlohmann::json trial_json(const Scene& scene, const std::vector<ProjectorOutcome>& outcomes,
                          const StageTimes& times);

/// One estimate: the keys of "estimate" above, beside name, status, reason, size, device_from_world (3×4),
/// parameters and covariance (row-major, in their order), and the predicted error over the volume with its
/// two parts, whose squares add up: "predicted_volume_px": {"from_noise", "from_camera"}.
nlohmann::json estimate_json(const std::string& name, const SolveResult& solve);

/// {"format": "laterna-estimate", "version": 1, "projectors": [estimate_json...], "given_cameras":
/// [device...]}: what `laterna calibrate` writes. The cameras are as they were believed (sim/believed.h):
/// formats that hold a camera beside a projector need one.
std::string estimates_text(const std::vector<nlohmann::json>& estimates, const Scene& believed);

/// An estimate that was read back.
struct StoredEstimate {
  Device device;
  std::vector<double> covariance;
};

/// What estimates_text wrote, without the refused ones. Throws InputError, naming the file, where it is
/// something else.
std::vector<StoredEstimate> read_estimates(const std::filesystem::path& file);

/// {"rms", "max", "points", "predicted_rms"}.
nlohmann::json error_json(const ErrorSummary& error);

std::string status_word(Status status);

/// The report that `laterna roundtrip` prints: recovered T beside the true one, errors beside what noise
/// alone predicts, each parameter with its standard deviation, and the verdict.
std::string trial_text(const Scene& scene, const std::vector<ProjectorOutcome>& outcomes);

/// The estimate's parameters with their sigmas, its T, and the fit: for people.
std::string solve_text(const SolveResult& solve, const Device* truth);

/// A line per set of points: rms, max, points and the prediction.
std::string verification_text(const Verification& verification);

}  // namespace laterna
