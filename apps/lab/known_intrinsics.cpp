#include "apps/lab/known_intrinsics.h"

#include "apps/lab/trial_report.h"
#include "sim/cameramodel_file.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

KnownIntrinsics known_of(const StoredEstimate& stored) {
  KnownIntrinsics known{stored.device.intrinsics, stored.device.lens, {}};
  const std::size_t k = 4 + stored.device.lens.parameters.size(), p = k + 6;
  if (stored.covariance.size() != p * p) return known;
  for (std::size_t i = 0; i < k; ++i)
    known.sigma.push_back(std::sqrt(std::max(0.0, stored.covariance[i * p + i])));
  return known;
}

KnownIntrinsics from_estimate(const std::string& file, const std::string& name) {
  const std::vector<StoredEstimate> stored = read_estimates(file);
  if (name.empty() && stored.size() == 1) return known_of(stored[0]);
  if (name.empty())
    throw InputError(
        fmt::format("{}: holds {} estimates, expected one, or NAME={}", file, stored.size(), file));
  const auto named = [&](const StoredEstimate& s) { return s.device.name == name; };
  const auto found = std::find_if(stored.begin(), stored.end(), named);
  if (found == stored.end()) throw InputError(fmt::format("{}: holds no estimate of \"{}\"", file, name));
  return known_of(*found);
}

}  // namespace

KnownByName read_known_intrinsics(const std::vector<std::string>& words) {
  KnownByName known;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = equals == word.npos ? "" : word.substr(0, equals);
    const std::string file = equals == word.npos ? word : word.substr(equals + 1);
    if (known.contains(name))
      throw InputError(fmt::format("known intrinsics: \"{}\" is the second for {}", word,
                                   name.empty() ? "all projectors" : "\"" + name + "\""));
    if (!file.ends_with(".cameramodel")) {
      known[name] = from_estimate(file, name);
      continue;
    }
    const Device device = read_cameramodel(file);
    known[name] = {device.intrinsics, device.lens, {}};
  }
  return known;
}

std::optional<KnownIntrinsics> known_for(const KnownByName& known, const std::string& projector) {
  for (const std::string& name : {projector, std::string()})
    if (const auto found = known.find(name); found != known.end()) return found->second;
  return std::nullopt;
}

}  // namespace laterna
