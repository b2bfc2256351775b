#include "calib/boards/board_capture.h"

#include "sim/error.h"
#include "sim/intrinsics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace laterna {

namespace {

bool finite(const glm::dvec3& x) { return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z); }

void validate(const Sighting& s, const BoardDevice& device, int label) {
  const auto place = [&] { return fmt::format("pose {}, corner {}, {}", label, s.corner, device.name); };
  if (s.read_at) {
    const glm::dmat2& slope = s.read_at->slope;
    if (!finite({s.read_at->pixel, 0}) || !finite({slope[0], slope[1].x}) || !std::isfinite(slope[1].y))
      throw InputError(
          fmt::format("{}: the camera's pixel or the slope of a reading is not finite", place()));
  }
  if (!finite(s.x_board) || !finite({s.pixel, 0})) {
    throw InputError(fmt::format("{}: board point ({}, {}, {}) and pixel ({}, {}), expected finite numbers",
                                 place(), s.x_board.x, s.x_board.y, s.x_board.z, s.pixel.x, s.pixel.y));
  }
  if (!(s.sigma_px > 0 && std::isfinite(s.sigma_px)))
    throw InputError(fmt::format("{}: sigma is {} px, expected a positive number", place(), s.sigma_px));
  const glm::dvec2 size(device.size), beyond = glm::max(-s.pixel, s.pixel - size + 1.0) - 0.1 * size;
  if (std::max(beyond.x, beyond.y) > 0) {
    throw InputError(fmt::format("{}: pixel ({}, {}) lies outside, expected one in an image of {}x{}",
                                 place(), s.pixel.x, s.pixel.y, device.size.x, device.size.y));
  }
}

}  // namespace

void validate(const BoardCapture& capture) {
  if (capture.devices.empty()) throw InputError("board capture: no device, expected at least a camera");
  for (const BoardDevice& device : capture.devices) {
    validate(Intrinsics{device.size, 1, 1, 0, 0}, device.name.c_str());
    if (!device.known) continue;
    laterna::validate(*device.known);
    const glm::ivec2 found = device.known->intrinsics.size;
    if (found != device.size)
      throw InputError(fmt::format("{}: the known intrinsics are of {}x{} px, expected {}x{}", device.name,
                                   found.x, found.y, device.size.x, device.size.y));
    const std::size_t sigmas = device.known_sigma.size(),
                      parameters = 4 + device.known->lens.parameters.size();
    if (sigmas > 0 && sigmas != parameters)
      throw InputError(
          fmt::format("{}: {} sigmas of the known intrinsics, expected {}", device.name, sigmas, parameters));
    for (const double sigma : device.known_sigma)
      if (!(sigma >= 0) || !std::isfinite(sigma))
        throw InputError(fmt::format("{}: a sigma of the known intrinsics is {}, expected a number from 0",
                                     device.name, sigma));
  }
  for (const Sighting& s : capture.sightings) {
    const bool in_range = s.device >= 0 && s.device < int(capture.devices.size()) && s.pose >= 0 &&
                          s.pose < capture.pose_count() &&
                          (!s.read_at || (s.read_at->device >= 0 && s.read_at->device < s.device));
    if (!in_range) {
      throw InputError(
          fmt::format("board capture: a sighting has device {} and pose {}, expected less than {} and {}",
                      s.device, s.pose, capture.devices.size(), capture.pose_count()));
    }
    validate(s, capture.devices[s.device], capture.pose_labels[s.pose]);
  }
}

void complete_table(BoardCapture& capture, const std::string& file_name) {
  std::map<int, int> index;
  for (const Sighting& s : capture.sightings) index.emplace(s.pose, 0);
  for (auto& [label, at] : index) {
    at = capture.pose_count();
    capture.pose_labels.push_back(label);
  }
  for (Sighting& s : capture.sightings) s.pose = index.at(s.pose);
  capture.extent = extent_of(capture.sightings);
  try {
    validate(capture);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file_name, error.what()));
  }
}

BoardExtent extent_of(const std::vector<Sighting>& sightings) {
  if (sightings.empty()) return {};
  glm::dvec2 low(sightings.front().x_board), high = low;
  for (const Sighting& s : sightings)
    low = glm::min(low, glm::dvec2(s.x_board)), high = glm::max(high, glm::dvec2(s.x_board));
  const glm::dvec2 half = (high - low) / 2.0;
  return {(low + high) / 2.0, {half.x > 0 ? half.x : 1, half.y > 0 ? half.y : 1}};
}

BoardCapture with_poses(const BoardCapture& capture, const std::vector<int>& poses) {
  BoardCapture chosen{capture.devices, {}, {}, capture.extent};
  for (const int pose : poses) {
    for (const Sighting& s : capture.sightings) {
      if (s.pose != pose) continue;
      chosen.sightings.push_back(s);
      chosen.sightings.back().pose = chosen.pose_count();
    }
    chosen.pose_labels.push_back(capture.pose_labels[pose]);
  }
  return chosen;
}

BoardCapture without_pose(const BoardCapture& capture, int pose) {
  std::vector<int> rest;
  for (int k = 0; k < capture.pose_count(); ++k)
    if (k != pose) rest.push_back(k);
  return with_poses(capture, rest);
}

BoardCapture seen_by_cameras(const BoardCapture& capture) {
  BoardCapture seen = capture;
  std::erase_if(seen.sightings, [&](const Sighting& s) { return !is_camera(capture, s.device); });
  return seen;
}

BoardCapture seen_by(const BoardCapture& capture, int device) {
  BoardCapture seen = capture;
  std::erase_if(seen.sightings, [&](const Sighting& s) { return s.device != device; });
  return seen;
}

}  // namespace laterna
