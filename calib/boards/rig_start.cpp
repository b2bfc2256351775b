#include "calib/boards/rig_start.h"

#include "calib/boards/adjust.h"
#include "calib/boards/known_devices.h"
#include "calib/placement.h"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr double start_sigma_px = 1;  // a start is good or bad in pixels, whatever the noise

struct PosePoints {
  std::vector<cv::Point3f> board;
  std::vector<cv::Point2f> pixel;
};

PosePoints points_of(const BoardCapture& capture, int device, int pose) {
  PosePoints points;
  for (const Sighting& s : capture.sightings) {
    if (s.device != device || s.pose != pose) continue;
    points.board.emplace_back(float(s.x_board.x), float(s.x_board.y), float(s.x_board.z));
    points.pixel.emplace_back(float(s.pixel.x), float(s.pixel.y));
  }
  return points;
}

bool is_flat(const std::vector<cv::Point3f>& board) {
  return std::all_of(board.begin(), board.end(), [](const cv::Point3f& x) { return x.z == 0; });
}

Rigid rigid_of(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  const auto vector = [](const cv::Mat& m) {
    return glm::dvec3(m.at<double>(0), m.at<double>(1), m.at<double>(2));
  };
  return rigid_from_rotation_vector(vector(rotation_vector), vector(translation));
}

// Zhang's focal length; 0 where the homographies give none.
double focal_from_homographies(const BoardCapture& capture) {
  std::vector<std::vector<cv::Point3f>> boards;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (int k = 0; k < capture.pose_count(); ++k) {
    PosePoints points = points_of(capture, 0, k);
    if (!is_flat(points.board)) return 0;
    boards.push_back(std::move(points.board));
    pixels.push_back(std::move(points.pixel));
  }
  const glm::ivec2 size = capture.devices[0].size;
  try {
    const cv::Mat k = cv::initCameraMatrix2D(boards, pixels, {size.x, size.y}, 1);
    const double f = k.at<double>(0, 0);
    return std::isfinite(f) && f > 0.05 * size.x && f < 100.0 * size.x ? f : 0;
  } catch (const cv::Exception&) {
    return 0;
  }
}

RigModel camera_alone(const BoardCapture& capture) {
  RigModel model;
  model.devices.assign(capture.devices.size(), {});
  for (DeviceModel& m : model.devices) m.held = true;
  model.devices[0].held = false;
  model.devices[0].one_focal_length = model.devices[0].fixed_center = true;
  return model;
}

// The camera and all poses from one focal length.
std::optional<Adjustment> camera_from_focal(const BoardCapture& capture, double f) {
  const glm::ivec2 size = capture.devices[0].size;
  BoardRig rig;
  rig.devices.resize(capture.devices.size());
  for (RigDevice& device : rig.devices) device.parameters = {f, f, (size.x - 1) / 2.0, (size.y - 1) / 2.0};
  for (int k = 0; k < capture.pose_count(); ++k) {
    const auto pose = board_pose(capture, 0, k, rig.devices[0].parameters);
    if (!pose) return std::nullopt;
    rig.camera_from_board.push_back(*pose);
  }
  BoardCapture camera = seen_by(capture, 0);
  for (Sighting& s : camera.sightings) s.sigma_px = start_sigma_px;
  return adjust({camera, camera_alone(capture), {RobustLoss::Kind::cauchy, 3}}, rig, 100);
}

// A known camera: each board where the camera sees it, through its lens.
std::optional<BoardRig> start_known_camera(const BoardCapture& capture) {
  const BoardCapture straight = straightened(capture);
  BoardRig rig;
  rig.devices.resize(capture.devices.size());
  rig.devices[0].parameters = state_of(*capture.devices[0].known).parameters;
  for (int k = 0; k < capture.pose_count(); ++k) {
    const auto pose = board_pose(straight, 0, k, rig.devices[0].parameters);
    if (!pose) return std::nullopt;
    rig.camera_from_board.push_back(*pose);
  }
  return rig;
}

std::optional<BoardRig> start_camera(const BoardCapture& capture) {
  if (capture.devices[0].known) return start_known_camera(capture);
  std::optional<Adjustment> best;
  const auto consider = [&](double f) {
    auto tried = camera_from_focal(capture, f);
    if (tried && tried->rig.devices[0].parameters[0] > 0 && (!best || tried->loss < best->loss))
      best = std::move(tried);
  };
  const double zhang = focal_from_homographies(capture);
  if (zhang > 0) consider(zhang);
  const double corners = double(seen_by(capture, 0).sightings.size());
  if (!best || best->loss > 9 * corners) {  // beyond some 3 px rms
    for (const double throw_ratio : {0.5, 1.0, 2.0, 5.0}) consider(throw_ratio * capture.devices[0].size.x);
  }
  if (!best) return std::nullopt;
  return best->rig;
}

// A known device from points in the camera's frame; the reason where there is none.
std::string start_known_device(const Device& known, const Correspondences& c, RigDevice& device) {
  const BestRefinement best = place(c, {known.intrinsics, known.lens});
  if (!best.refinement) return best.refusal;
  device = {state_of(known).parameters, best.refinement->state.device_from_points};
  return "";
}

// A device from points of the boards that stand already, in the camera's frame; the reason where there is
// none.
std::string start_device(const BoardCapture& capture, const std::vector<char>& stands, int d, BoardRig& rig) {
  Correspondences c;
  for (const Sighting& s : capture.sightings) {
    if (s.device != d || !stands[s.pose]) continue;
    c.world_points.push_back(apply(rig.camera_from_board[s.pose], s.x_board));
    c.projector_pixels.push_back(s.pixel);
    c.sigma_px.push_back(start_sigma_px);
  }
  const std::string& name = capture.devices[d].name;
  if (const auto& known = capture.devices[d].known) {
    const std::string refusal = start_known_device(*known, c, rig.devices[d]);
    return refusal.empty() ? "" : fmt::format("{}: {}", name, refusal);
  }
  const LensGradient pinhole("LENSMODEL_PINHOLE");
  const GeometryReport geometry = check_geometry(c, pinhole.parameter_count() + 6);
  if (geometry.verdict != Geometry::sound) return fmt::format("{}: {}", name, geometry.reason);
  const WorldNormalisation n = normalisation_of(c.world_points);
  const PointTable points = point_table(c, n);
  const BestRefinement best =
      best_refinement(c, points, n, capture.devices[d].size, pinhole, geometry, SolveOptions{});
  if (!best.refinement) return fmt::format("{}: {}", name, best.refusal);
  rig.devices[d] = {best.refinement->state.parameters,
                    device_from_world(best.refinement->state.device_from_points, n)};
  return "";
}

// Boards that none but camera d sees, by where it stands; false where there is none of them.
bool stand_boards(const BoardCapture& straight, int d, std::vector<char>& stands, BoardRig& rig) {
  bool any = false;
  for (const int k : poses_seen_by(straight, d)) {
    if (stands[k]) continue;
    const auto device_from_board = board_pose(straight, d, k, rig.devices[d].parameters);
    if (!device_from_board) continue;
    rig.camera_from_board[k] = compose(inverse(rig.devices[d].device_from_camera), *device_from_board);
    stands[k] = 1, any = true;
  }
  return any;
}

// Devices from boards that stand and boards from cameras that stand, in turn; the reason where one remains.
std::string start_others(const BoardCapture& capture, std::vector<char>& stands, BoardRig& rig) {
  const BoardCapture straight = straightened(capture);
  std::vector<std::string> missing(capture.devices.size(), "not tried");
  missing[0].clear();
  for (bool more = true; more;) {
    more = false;
    for (int d = 1; d < int(capture.devices.size()); ++d) {
      if (missing[d].empty()) continue;
      missing[d] = start_device(capture, stands, d, rig);
      if (missing[d].empty() && is_camera(capture, d)) more |= stand_boards(straight, d, stands, rig);
    }
  }
  for (const std::string& reason : missing)
    if (!reason.empty()) return reason;
  for (int k = 0; k < capture.pose_count(); ++k)
    if (!stands[k])
      return fmt::format("pose {}: no camera sees 4 corners or more of it in front", capture.pose_labels[k]);
  return "";
}

}  // namespace

std::optional<Rigid> board_pose(const BoardCapture& capture, int device, int pose,
                                const std::vector<double>& k) {
  const PosePoints points = points_of(capture, device, pose);
  if (points.board.size() < 4) return std::nullopt;
  const cv::Matx33d matrix(k[0], 0, k[2], 0, k[1], k[3], 0, 0, 1);
  std::vector<cv::Mat> rotations, translations;
  try {
    cv::solvePnPGeneric(points.board, points.pixel, matrix, cv::noArray(), rotations, translations, false,
                        is_flat(points.board) ? cv::SOLVEPNP_IPPE : cv::SOLVEPNP_SQPNP);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  for (std::size_t n = 0; n < rotations.size(); ++n) {  // sorted by reprojection error
    const Rigid camera_from_board = rigid_of(rotations[n], translations[n]);
    const bool in_front = std::all_of(points.board.begin(), points.board.end(), [&](const cv::Point3f& x) {
      return apply(camera_from_board, {x.x, x.y, x.z}).z > 0;
    });
    if (in_front) return camera_from_board;
  }
  return std::nullopt;
}

std::vector<int> poses_seen_by(const BoardCapture& capture, int device) {
  std::vector<int> corners(capture.pose_labels.size(), 0), seen;
  for (const Sighting& s : capture.sightings) corners[s.pose] += s.device == device;
  for (int k = 0; k < capture.pose_count(); ++k)
    if (corners[k] >= 4) seen.push_back(k);
  return seen;
}

RigStart start_rig(const BoardCapture& capture) {
  const std::vector<int> seen = poses_seen_by(capture, 0);
  if (seen.empty())
    return {{},
            fmt::format("no pose: {} sees no board with 4 corners or more", capture.devices.front().name)};
  std::optional<BoardRig> rig = start_camera(with_poses(capture, seen));
  if (!rig)
    return {{},
            fmt::format("{}: no focal length gives every board a pose in front of it (is a picture mirrored, "
                        "or are all corners of a pose on one line?)",
                        capture.devices[0].name)};
  std::vector<char> stands(capture.pose_labels.size(), 0);
  std::vector<Rigid> boards(capture.pose_labels.size());
  for (std::size_t n = 0; n < seen.size(); ++n)
    boards[seen[n]] = rig->camera_from_board[n], stands[seen[n]] = 1;
  rig->camera_from_board = std::move(boards);
  const std::string refusal = start_others(capture, stands, *rig);
  if (!refusal.empty()) return {{}, refusal};
  return {rig, ""};
}

}  // namespace laterna
