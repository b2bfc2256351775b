#include "apps/lab/board_places.h"

#include "sim/error.h"
#include "sim/printed_board.h"
#include "sim/rigid.h"
#include "sim/scene_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace laterna {

namespace {

constexpr double margin = 0.02;        // of the camera's image
constexpr double least_facing = 0.34;  // cosine, about 70° off the normal

/// Draws that are the same on every platform.
struct Draws {
  std::mt19937_64 random;
  double uniform(double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1p-53; }
};

/// A device that the board must face.
struct Eye {
  WorldProjection projection;
  glm::dvec3 center_world;
  glm::dvec2 size;

  explicit Eye(const Device& device)
      : projection(device),
        center_world(center_in_world(device.device_from_world)),
        size(device.intrinsics.size) {}

  bool sees(const glm::dvec3& x_world, double inside) const {
    const glm::dvec3 p = projection.project(x_world);
    const glm::dvec2 low = inside * size - 0.5, high = (1 - inside) * size - 0.5;
    return p.z > 0 && p.x > low.x && p.y > low.y && p.x < high.x && p.y < high.y;
  }
  bool faces(const Rigid& world_from_board) const {
    const glm::dvec3 to_eye = glm::normalize(center_world - world_from_board.translation);
    return glm::dot(to_eye, world_from_board.rotation[2]) > least_facing;
  }
};

struct Rig {
  Eye camera;
  std::vector<Eye> projectors;
  glm::dvec3 middle_world{0.0};  // of all devices
  double distance_m = 0;         // of the board as it stands
};

Rig rig_of(const Scene& scene, const glm::dvec3& board_world) {
  Rig rig{Eye(scene.cameras[0].device), {}};
  rig.middle_world = rig.camera.center_world;
  for (const Projector& p : scene.projectors) {
    rig.projectors.emplace_back(p.device);
    rig.middle_world += rig.projectors.back().center_world;
  }
  rig.middle_world /= double(1 + rig.projectors.size());
  rig.distance_m = glm::distance(board_world, rig.camera.center_world);
  return rig;
}

glm::dmat3 about(const glm::dvec3& axis, double angle_deg) {
  return rigid_from_rotation_vector(axis * glm::radians(angle_deg), glm::dvec3(0.0)).rotation;
}

// x and y of the print, and its normal towards the viewer, before tilt and roll.
glm::dmat3 upright(const glm::dvec3& normal, const glm::dmat3& camera_from_world) {
  const glm::dvec3 camera_up = -glm::transpose(camera_from_world)[1];
  const glm::dvec3 x = glm::normalize(glm::cross(camera_up, normal));
  return {x, glm::cross(normal, x), normal};
}

std::optional<Rigid> draw_place(const Rig& rig, const glm::dmat3& camera_from_world,
                                const BoardPlaceOptions& o, Draws& draws) {
  const glm::dvec2 pixel(draws.uniform(0.1, 0.9) * rig.camera.size.x,
                         draws.uniform(0.1, 0.9) * rig.camera.size.y);
  const double distance = rig.distance_m * draws.uniform(o.nearest, o.farthest);
  const double turn = draws.uniform(0, 2 * std::numbers::pi);
  const double tilt = draws.uniform(o.least_tilt_deg, o.most_tilt_deg);
  const double roll = draws.uniform(-o.most_roll_deg, o.most_roll_deg);
  const auto on_ray = rig.camera.projection.unproject(pixel, 1);
  if (!on_ray) return {};
  const glm::dvec3 middle =
      rig.camera.center_world + distance * glm::normalize(*on_ray - rig.camera.center_world);
  const glm::dmat3 straight = upright(glm::normalize(rig.middle_world - middle), camera_from_world);
  const glm::dmat3 tilted =
      straight * about({std::cos(turn), std::sin(turn), 0}, tilt) * about({0, 0, 1}, roll);
  return Rigid{tilted, middle};
}

// The board's points about its middle, x right, y up.
std::vector<glm::dvec3> centred_points(const PrintedBoard& board, double scale) {
  std::vector<glm::dvec3> points = board_points(board);
  glm::dvec3 last(0.0);
  for (const glm::dvec3& p : points) last = glm::max(last, p);
  for (glm::dvec3& p : points) p = scale * glm::dvec3(p.x - last.x / 2, last.y / 2 - p.y, 0);
  return points;
}

bool is_good(const Rig& rig, const Rigid& world_from_board, const std::vector<glm::dvec3>& points,
             double least_lit) {
  if (!rig.camera.faces(world_from_board)) return false;
  std::vector<glm::dvec3> world;
  for (const glm::dvec3& p : points) world.push_back(apply(world_from_board, p));
  if (!std::all_of(world.begin(), world.end(), [&](const auto& p) { return rig.camera.sees(p, margin); }))
    return false;
  return std::all_of(rig.projectors.begin(), rig.projectors.end(), [&](const Eye& eye) {
    const auto lit = std::count_if(world.begin(), world.end(), [&](const auto& p) { return eye.sees(p, 0); });
    return eye.faces(world_from_board) && double(lit) >= least_lit * double(world.size());
  });
}

MeshSpec placed(MeshSpec mesh, const Rigid& world_from_board) {
  Matrix3x4 rows = rows_of(world_from_board);
  for (auto& row : rows)
    for (int j = 0; j < 3; ++j) row[std::size_t(j)] *= mesh.scale;
  mesh.world_from_object = rows;
  mesh.scale = 1, mesh.rotate_deg = glm::dvec3(0.0), mesh.translate = glm::dvec3(0.0);
  return mesh;
}

}  // namespace

std::vector<SceneSpec> board_places(const SceneSpec& spec, const std::filesystem::path& folder,
                                    const BoardPlaceOptions& options, std::uint64_t seed) {
  const Scene scene = build_scene(spec, folder);
  const auto mesh =
      std::find_if(spec.meshes.begin(), spec.meshes.end(), [](const auto& m) { return !m.board.empty(); });
  if (mesh == spec.meshes.end())
    throw InputError("the scene has no [[mesh]] with board, expected one to place");
  if (scene.cameras.empty() || scene.projectors.empty())
    throw InputError("the scene has no camera or no projector, expected both to place a board before");
  const std::size_t index = std::size_t(mesh - spec.meshes.begin());
  const Rig rig = rig_of(scene, glm::dvec3(scene.objects[index].world_from_object[3]));
  const auto points = centred_points(parse_board(mesh->board), mesh->scale);
  Draws draws{std::mt19937_64(seed)};
  std::vector<SceneSpec> places;
  for (int tries = 0; int(places.size()) < options.count; ++tries) {
    if (tries == 10000 * options.count)
      throw InputError(
          fmt::format("{} of {} places of the board found that the camera sees whole and each projector "
                      "lights to {:.0f} %: expected a smaller board, or devices that look at one place",
                      places.size(), options.count, 100 * options.least_lit));
    const auto place = draw_place(rig, scene.cameras[0].device.device_from_world.rotation, options, draws);
    if (!place || !is_good(rig, *place, points, options.least_lit)) continue;
    places.push_back(spec);
    places.back().meshes[index] = placed(*mesh, *place);
  }
  return places;
}

}  // namespace laterna
