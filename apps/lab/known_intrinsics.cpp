#include "apps/lab/known_intrinsics.h"

#include "apps/lab/trial_report.h"
#include "calib/boards/rig.h"
#include "sim/cameramodel_file.h"
#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
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

using Entries = std::vector<std::pair<std::string, KnownIntrinsics>>;

// By the parameters' names; 0 for what was held, and for fy that of fx where both are one focal length.
std::vector<double> sigmas_of(const nlohmann::json& entry, const Lens& lens) {
  const nlohmann::json& stored = entry.value("sigma", nlohmann::json::object());
  const bool one_focal_length = stored.contains("fx") && !stored.contains("fy");
  std::vector<std::string> names = {"fx", one_focal_length ? "fx" : "fy", "cx", "cy"};
  for (int i = 0; i < int(lens.parameters.size()); ++i) names.push_back(lens_parameter_name(lens.model, i));
  std::vector<double> sigma;
  for (const std::string& name : names) sigma.push_back(stored.value(name, 0.0));
  return sigma;
}

// Cameras and projectors of a calibration from boards; none where the file is another one.
Entries entries_of_boards(const std::string& file) {
  Entries entries;
  const auto json = nlohmann::json::parse(read_text(file, 1 << 26), nullptr, false);
  if (!json.is_object() || !json.contains("cameras") || !json.contains("projectors")) return entries;
  try {
    for (const char* kind : {"cameras", "projectors"}) {
      for (const auto& entry : json.at(kind)) {
        const auto size = entry.at("size").get<std::array<int, 2>>();
        const auto& lens = entry.at("lens");
        KnownIntrinsics known{
            {{size[0], size[1]}, entry.at("fx"), entry.at("fy"), entry.at("cx"), entry.at("cy")},
            {lens.at("model"), lens.at("parameters")}};
        known.sigma = sigmas_of(entry, known.lens);
        entries.push_back({entry.at("name"), std::move(known)});
      }
    }
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        fmt::format("{}: {}, expected what `laterna calibrate` wrote of boards", file, error.what()));
  }
  return entries;
}

Entries entries_of(const std::string& file) {
  Entries entries = entries_of_boards(file);
  if (!entries.empty()) return entries;
  for (const StoredEstimate& stored : read_estimates(file))
    entries.emplace_back(stored.device.name, known_of(stored));
  if (entries.empty()) throw InputError(fmt::format("{}: holds no estimate that was not refused", file));
  return entries;
}

// Under the name that was asked for; without one the only entry as "", or all by their own names.
Entries from_estimate(const std::string& file, const std::string& name) {
  Entries entries = entries_of(file);
  if (name.empty() && entries.size() == 1) return {{"", entries[0].second}};
  if (name.empty()) return entries;
  std::erase_if(entries, [&](const auto& entry) { return entry.first != name; });
  if (entries.empty()) throw InputError(fmt::format("{}: holds no estimate of \"{}\"", file, name));
  return {entries.front()};
}

}  // namespace

KnownByName read_known_intrinsics(const std::vector<std::string>& words) {
  KnownByName known;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string name = equals == word.npos ? "" : word.substr(0, equals);
    const std::string file = equals == word.npos ? word : word.substr(equals + 1);
    Entries entries;
    if (file.ends_with(".cameramodel")) {
      const Device device = read_cameramodel(file);
      entries = {{name, {device.intrinsics, device.lens, {}}}};
    } else {
      entries = from_estimate(file, name);
    }
    for (auto& [of, intrinsics] : entries) {
      if (!known.emplace(of, std::move(intrinsics)).second)
        throw InputError(fmt::format("known intrinsics: \"{}\" is the second for {}", word,
                                     of.empty() ? "all devices" : "\"" + of + "\""));
    }
  }
  return known;
}

void add_known(BoardCapture& capture, const KnownByName& known) {
  for (const auto& [name, intrinsics] : known) {
    const auto device = std::find_if(capture.devices.begin(), capture.devices.end(),
                                     [&name = name](const BoardDevice& d) { return d.name == name; });
    if (device == capture.devices.end())
      throw InputError(name.empty()
                           ? std::string("known intrinsics: of which device, expected NAME=FILE")
                           : fmt::format("known intrinsics: the boards were seen by no \"{}\"", name));
    device->known = Device{name, intrinsics.intrinsics, {}, intrinsics.lens, {}};
    device->known_sigma = intrinsics.sigma;
  }
}

std::optional<KnownIntrinsics> known_for(const KnownByName& known, const std::string& projector) {
  for (const std::string& name : {projector, std::string()})
    if (const auto found = known.find(name); found != known.end()) return found->second;
  return std::nullopt;
}

}  // namespace laterna
