// Point clouds as PLY: what meshing and alignment tools read, and what structured-light scanners write.
#pragma once

#include <glm/glm.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace laterna {

struct CloudPoint {
  glm::dvec3 x_world{0.0};       ///< metres
  glm::dvec2 projector_px{0.0};  ///< which projector pixel lights it; integer coordinates at pixel centres
  glm::dvec2 camera_px{0.0};     ///< which camera pixel sees it
};

/// A binary little-endian PLY file of element `vertex` alone: x, y, z as doubles (metres, the world's axes),
/// projector_u, projector_v, camera_u, camera_v as floats.
std::string point_cloud_ply(const std::vector<CloudPoint>& points);

/// A cloud from a file. Its frame and unit are whatever its maker chose; pixels that it does not have are 0.
struct PointCloud {
  std::vector<CloudPoint> points;  ///< at least one
  bool has_projector_px = false, has_camera_px = false;
};

/// Reads a PLY file, given as bytes: ascii or binary of either byte order, numbers of any type. Points are x,
/// y, z of element `vertex`, as they stand; pixels are projector_u and projector_v, camera_u and camera_v.
/// Other properties, lists too, and other elements (a mesh's faces) are passed over. `name` begins each
/// message.
///
/// Throws InputError, naming the line (text) or the record (binary), for what read_ply (sim/ply.h) refuses of
/// a header and of records: truncated, too long, words that are no numbers, nan or infinity; and where there
/// is no element `vertex`, it is empty, or it lacks x, y or z, or one of two pixel coordinates.
PointCloud read_point_cloud(std::string_view bytes, const std::string& name);

/// The same from a file of at most 4 GiB.
PointCloud read_point_cloud(const std::filesystem::path& path);

/// Whether a file begins as a PLY file does.
bool is_ply_file(const std::filesystem::path& path);

}  // namespace laterna
