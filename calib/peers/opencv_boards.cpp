// OpenCV's calibration of two devices from boards, as a peer.
#include "calib/peers/board_methods.h"
#include "sim/error.h"
#include "sim/spline_knots.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>

#include <map>

namespace laterna {

namespace {

using Points3 = std::vector<std::vector<cv::Point3f>>;
using Points2 = std::vector<std::vector<cv::Point2f>>;

struct Views {
  Points3 board;
  Points2 pixels[2];
};

// The corners of each pose that every one of the named devices has: OpenCV wants the same ones for all.
Views views_of(const BoardCapture& capture, const std::vector<int>& devices) {
  Views views;
  for (int pose = 0; pose < capture.pose_count(); ++pose) {
    std::map<int, std::map<int, const Sighting*>> corners;
    for (const Sighting& s : capture.sightings)
      if (s.pose == pose) corners[s.corner][s.device] = &s;
    views.board.emplace_back();
    for (std::size_t n = 0; n < devices.size(); ++n) views.pixels[n].emplace_back();
    for (const auto& [corner, seen] : corners) {
      if (!std::all_of(devices.begin(), devices.end(), [&](int d) { return seen.contains(d); })) continue;
      const glm::dvec3& x = seen.begin()->second->x_board;
      views.board.back().emplace_back(float(x.x), float(x.y), float(x.z));
      for (std::size_t n = 0; n < devices.size(); ++n) {
        const glm::dvec2& p = seen.at(devices[n])->pixel;
        views.pixels[n].back().emplace_back(float(p.x), float(p.y));
      }
    }
  }
  return views;
}

int flags_of(const DeviceModel& m) {
  if (is_splined(m.lens_model)) throw Refusal("OpenCV has no splined lens");
  const auto free = [&](std::size_t i) { return i < m.lens_free.size() && m.lens_free[i]; };
  int flags = 0;
  if (!free(0)) flags |= cv::CALIB_FIX_K1;
  if (!free(1)) flags |= cv::CALIB_FIX_K2;
  if (!free(2)) flags |= cv::CALIB_ZERO_TANGENT_DIST;
  if (!free(4)) flags |= cv::CALIB_FIX_K3;
  if (free(5)) flags |= cv::CALIB_RATIONAL_MODEL;
  if (free(8)) flags |= cv::CALIB_THIN_PRISM_MODEL;
  if (m.one_focal_length) flags |= cv::CALIB_FIX_ASPECT_RATIO;
  if (m.fixed_center) flags |= cv::CALIB_FIX_PRINCIPAL_POINT;
  return flags;
}

const cv::TermCriteria until_converged(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 500, 1e-12);

void check(const BoardCapture& capture, const RigModel& model) {
  if (capture.devices.size() != 2) throw Refusal("OpenCV takes two devices");
  if (model.bend) throw Refusal("OpenCV has no bend of the board");
  for (const Sighting& s : capture.sightings)
    if (s.x_board.z != 0) throw Refusal("OpenCV's starts want a flat board");
}

std::vector<double> parameters_of(const cv::Mat& k, const cv::Mat& lens, std::size_t lens_parameters) {
  std::vector<double> p = {k.at<double>(0, 0), k.at<double>(1, 1), k.at<double>(0, 2), k.at<double>(1, 2)};
  for (std::size_t i = 0; i < lens_parameters; ++i)
    p.push_back(i < lens.total() ? lens.reshape(1, 1).at<double>(0, int(i)) : 0);
  return p;
}

Rigid rigid_of(const cv::Mat& rotation, const cv::Mat& translation) {
  Rigid rigid;
  cv::Mat matrix = rotation;
  if (rotation.total() == 3) cv::Rodrigues(rotation, matrix);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rigid.rotation[j][i] = matrix.at<double>(i, j);
    rigid.translation[i] = translation.reshape(1, 1).at<double>(0, i);
  }
  return rigid;
}

struct Alone {
  cv::Mat k, lens;
  std::vector<cv::Mat> rotations, translations;
};

Alone calibrate_alone(const BoardCapture& capture, const RigModel& model, int device) {
  const Views views = views_of(capture, {device});
  Alone a;
  const glm::ivec2 size = capture.devices[device].size;
  a.k = cv::Mat::eye(3, 3, CV_64F);
  cv::calibrateCamera(views.board, views.pixels[0], {size.x, size.y}, a.k, a.lens, a.rotations,
                      a.translations, flags_of(model.devices[device]), until_converged);
  return a;
}

// OpenCV 4.6 keeps the poses of its joint solve to itself: the best ones for its devices.
BoardRig with_poses_of(const BoardCapture& capture, RigModel model, const BoardRig& rig) {
  for (DeviceModel& device : model.devices) device.held = true;
  const auto adjusted = adjust({capture, model}, rig);
  if (!adjusted) throw Refusal("OpenCV's rig has points behind a device");
  return adjusted->rig;
}

BoardRig solve(const BoardCapture& capture, const RigModel& model, bool joint) {
  check(capture, model);
  if (joint && flags_of(model.devices[0]) != flags_of(model.devices[1]))
    throw Refusal("OpenCV's joint solve takes one lens model for both devices");
  Alone camera = calibrate_alone(capture, model, 0), projector = calibrate_alone(capture, model, 1);
  const Views both = views_of(capture, {0, 1});
  cv::Mat rotation, translation, essential, fundamental;
  const glm::ivec2 size = capture.devices[0].size;
  const int flags =
      joint ? flags_of(model.devices[0]) | cv::CALIB_USE_INTRINSIC_GUESS : int(cv::CALIB_FIX_INTRINSIC);
  cv::stereoCalibrate(both.board, both.pixels[0], both.pixels[1], camera.k, camera.lens, projector.k,
                      projector.lens, {size.x, size.y}, rotation, translation, essential, fundamental, flags,
                      until_converged);
  BoardRig rig;
  rig.devices = {{parameters_of(camera.k, camera.lens, model.devices[0].lens_free.size()), {}},
                 {parameters_of(projector.k, projector.lens, model.devices[1].lens_free.size()),
                  rigid_of(rotation, translation)}};
  for (std::size_t k = 0; k < camera.rotations.size(); ++k)
    rig.camera_from_board.push_back(rigid_of(camera.rotations[k], camera.translations[k]));
  return joint ? with_poses_of(capture, model, rig) : rig;
}

BoardRig solve_or_refuse(const BoardCapture& capture, const RigModel& model, bool joint) {
  try {
    return solve(capture, model, joint);
  } catch (const cv::Exception& error) {
    throw Refusal(fmt::format("OpenCV throws: {}", error.err));
  }
}

}  // namespace

BoardRig solve_opencv_stepwise(const BoardCapture& capture, const RigModel& model) {
  return solve_or_refuse(capture, model, false);
}

BoardRig solve_opencv_joint(const BoardCapture& capture, const RigModel& model) {
  return solve_or_refuse(capture, model, true);
}

}  // namespace laterna
