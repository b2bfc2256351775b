#include "sim/formats/bop_models.h"

#include "sim/formats/tree.h"
#include "sim/safe_write.h"
#include "sim/smooth_normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace laterna {

namespace {

constexpr double millimetres_per_metre = 1e3;

Tree info_of(const Mesh& mesh) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::dvec3& x : mesh.positions) low = glm::min(low, x), high = glm::max(high, x);
  const glm::dvec3 from = low * millimetres_per_metre, size = (high - low) * millimetres_per_metre;
  return {{"diameter", largest_distance(mesh.positions) * millimetres_per_metre},
          {"min_x", from.x},
          {"min_y", from.y},
          {"min_z", from.z},
          {"size_x", size.x},
          {"size_y", size.y},
          {"size_z", size.z}};
}

}  // namespace

double largest_distance(const std::vector<glm::dvec3>& points) {
  if (points.size() < 2) return 0;
  const glm::dvec3 centroid =
      std::accumulate(points.begin(), points.end(), glm::dvec3(0.0)) / double(points.size());
  std::vector<glm::dvec4> far;  // from the centroid, and how far
  for (const glm::dvec3& x : points) far.emplace_back(x - centroid, glm::length(x - centroid));
  std::sort(far.begin(), far.end(), [](const glm::dvec4& a, const glm::dvec4& b) { return a.w > b.w; });
  double largest = 0;
  for (std::size_t i = 0; i < far.size() && 2 * far[i].w > largest; ++i)
    for (std::size_t j = i + 1; j < far.size() && far[i].w + far[j].w > largest; ++j)
      largest = std::max(largest, glm::length(glm::dvec3(far[i] - far[j])));
  return largest;
}

std::string bop_model_ply(const Mesh& mesh) {
  const std::vector<glm::dvec3> normals = smooth_normals(mesh, first_of_position(mesh));
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property double nx\nproperty double ny\nproperty double nz\nelement face {}\n"
      "property list uchar int vertex_indices\nend_header\n",
      mesh.positions.size(), mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::dvec3 x = mesh.positions[i] * millimetres_per_metre, &n = normals[i];
    fmt::format_to(std::back_inserter(text), "{} {} {} {} {} {}\n", x.x, x.y, x.z, n.x, n.y, n.z);
  }
  for (const glm::uvec3& t : mesh.triangles)
    fmt::format_to(std::back_inserter(text), "3 {} {} {}\n", t.x, t.y, t.z);
  return text;
}

void write_bop_models(const std::filesystem::path& folder, const std::vector<BopModel>& models) {
  const std::filesystem::path to = folder / "models";
  std::filesystem::create_directories(to);
  Tree info = Tree::object();
  for (const BopModel& model : models) {
    write_file(to / fmt::format("obj_{:06}.ply", model.obj_id), bop_model_ply(model.mesh));
    info[std::to_string(model.obj_id)] = info_of(model.mesh);
  }
  write_file(to / "models_info.json", info.dump(2) + "\n");
}

}  // namespace laterna
