#include "apps/lab/board_pictures.h"

#include "apps/lab/canvas.h"
#include "calib/boards/rig_rows.h"
#include "sim/error.h"
#include "sim/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace laterna {

namespace {

constexpr Rgb background{24, 26, 30}, ink{235, 235, 235};

/// One stroke: from the measured pixel, by the residual.
struct Stroke {
  glm::dvec2 at, residual;
};

std::vector<Stroke> strokes_of(const BoardCalibration& calibration, int device) {
  const RigFit& fit = calibration.ladder.fit;
  const RigProblem problem(fit.capture, fit.model);
  std::vector<Stroke> strokes;
  for (const Sighting& s : problem.sightings) {
    double pixel[2];
    if (s.device == device && predict(problem, fit.adjustment.rig, s, pixel, nullptr))
      strokes.push_back({s.pixel, glm::dvec2(pixel[0], pixel[1]) - s.pixel});
  }
  return strokes;
}

double rms_of(const std::vector<Stroke>& strokes) {
  double sum = 0;
  for (const Stroke& s : strokes) sum += glm::dot(s.residual, s.residual);
  return strokes.empty() ? 0 : std::sqrt(sum / double(strokes.size()));
}

// A hue of full saturation for a direction, red to the right, then yellow, green, cyan, blue, magenta
// clockwise.
Rgb hue(const glm::dvec2& direction) {
  const double turn = std::atan2(direction.y, direction.x) / (2 * std::numbers::pi) + 1;
  const auto channel = [&](double at) {
    const double distance = std::abs(std::remainder(turn - at, 1.0));
    return std::uint8_t(std::lround(255 * std::clamp(2 - 6 * distance, 0.0, 1.0)));
  };
  return {channel(0), channel(1.0 / 3), channel(2.0 / 3)};
}

void draw_dot(Canvas& canvas, const glm::dvec2& at, int radius, Rgb colour) {
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x)
      if (x * x + y * y <= radius * radius)
        canvas.set(int(std::lround(at.x)) + x, int(std::lround(at.y)) + y, colour);
}

void draw_ring(Canvas& canvas, const glm::dvec2& at, double radius, Rgb colour) {
  constexpr int sides = 24;
  const auto corner = [&](int k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    return at + radius * glm::dvec2(std::cos(angle), std::sin(angle));
  };
  for (int k = 0; k < sides; ++k) draw_line(canvas, corner(k), corner(k + 1), colour, 2);
}

Image<glm::u8vec3> picture_of(const Canvas& canvas) {
  Image<glm::u8vec3> picture(canvas.width, canvas.height);
  for (std::size_t i = 0; i < picture.values.size(); ++i)
    picture.values[i] = {canvas.rgb[3 * i], canvas.rgb[3 * i + 1], canvas.rgb[3 * i + 2]};
  return picture;
}

// (device, corner) of a pose's sightings.
std::set<std::pair<int, int>> sighted(const BoardCapture& capture, int label) {
  std::set<std::pair<int, int>> seen;
  for (const Sighting& s : capture.sightings)
    if (capture.pose_labels[std::size_t(s.pose)] == label) seen.emplace(s.device, s.corner);
  return seen;
}

}  // namespace

Image<glm::u8vec3> residual_picture(const BoardCalibration& calibration, int device, double magnification) {
  const BoardDevice& of = calibration.ladder.fit.capture.devices[std::size_t(device)];
  const std::vector<Stroke> strokes = strokes_of(calibration, device);
  const double rms = rms_of(strokes), scale = std::min(1.0, 1280.0 / of.size.x);
  const double longer = magnification > 0 ? magnification : rms > 0 ? of.size.x / 40.0 / rms : 1;
  Canvas canvas(int(std::lround(of.size.x * scale)), int(std::lround(of.size.y * scale)) + 40, background);
  for (const Stroke& s : strokes) {
    const glm::dvec2 from = s.at * scale, to = from + s.residual * longer * scale;
    draw_line(canvas, from, to, hue(s.residual), 2);
    draw_dot(canvas, from, 2, ink);
  }
  draw_text(canvas, {12, canvas.height - 28},
            fmt::format("{}: {} residuals, {:.3f} px rms, drawn {:.0f} times as long; hue = direction",
                        of.name, strokes.size(), rms, longer),
            13, ink);
  return picture_of(canvas);
}

Image<glm::u8vec3> placement_picture(const BoardFolders& folders, const BoardPlacement& placement) {
  const Image<float>& mean = placement.picture.mean;
  Canvas canvas(mean.width, mean.height, background);
  for (int y = 0; y < mean.height; ++y)
    for (int x = 0; x < mean.width; ++x) {
      const auto grey = std::uint8_t(std::lround(255 * mean(x, y)));
      canvas.set(x, y, {grey, grey, grey});
    }
  const BoardCapture& capture = folders.capture;
  const int devices = int(capture.devices.size()), radius = std::max(2, mean.width / 320);
  const auto seen = sighted(folders.capture, placement.pose);
  for (const Sighting& s : folders.capture.sightings) {
    if (capture.devices[std::size_t(s.device)].name != placement.camera ||
        capture.pose_labels[std::size_t(s.pose)] != placement.pose)
      continue;
    int read = 0, projectors = 0;
    for (int d = 1; d < devices; ++d) {
      if (is_camera(capture, d)) continue;
      ++projectors;
      read += int(seen.contains({d, s.corner}));
    }
    const Rgb colour = read == projectors ? Rgb{60, 220, 90}
                       : read > 0         ? Rgb{240, 210, 40}
                                          : Rgb{235, 60, 50};
    draw_dot(canvas, s.pixel, radius, colour);
    if (s.corner == 0) draw_ring(canvas, s.pixel, 4.0 * radius, colour);
  }
  return picture_of(canvas);
}

void write_board_pictures(const std::filesystem::path& folder, const BoardFolders& folders,
                          const BoardCalibration& calibration) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw InputError(
        fmt::format("{}: {}, expected a folder to write into", folder.string(), failed.message()));
  const bool several = folders.capture.devices.size() > 1 && is_camera(folders.capture, 1);
  for (const BoardPlacement& p : folders.placements)
    write_picture(folder / fmt::format("found_{:02}{}.png", p.pose, several ? "_" + p.camera : ""),
                  placement_picture(folders, p));
  if (calibration.status == Status::refused) return;
  for (int d = 0; d < int(calibration.devices.size()); ++d)
    write_picture(folder / fmt::format("residuals_{}.png", calibration.devices[std::size_t(d)].name),
                  residual_picture(calibration, d));
}

}  // namespace laterna
