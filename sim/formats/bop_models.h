// Models of BOP's: the meshes that a scene's objects are, and how large they are.
//
//   models/obj_000001.ply      text; x, y, z in millimetres, nx, ny, nz (smooth_normals.h), triangles
//   models/models_info.json    {"1": {"diameter", "min_x", "min_y", "min_z", "size_x", "size_y", "size_z"}}
//
// There millimetres, here metres; axes are the model's own at both ends (BOP would have z up and the origin
// in the middle of the box; its tools do not ask for it). `diameter` is the largest distance of two vertices,
// `min` and `size` are the box of all vertices. A scene of Laterna's takes such a file as it is, with
// unit = "mm". https://github.com/thodan/bop_toolkit/blob/master/docs/bop_datasets_format.md
#pragma once

#include "sim/mesh.h"

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

struct BopModel {
  int obj_id = 1;
  Mesh mesh;  ///< metres, in the model's frame; validated
};

/// The largest distance of two points, exactly: pairs that cannot reach the largest so far, by their
/// distances from the centroid, are left out. 0 for fewer than two.
double largest_distance(const std::vector<glm::dvec3>& points);

/// The text of obj_XXXXXX.ply.
std::string bop_model_ply(const Mesh& mesh);

/// Fills `folder`/models.
void write_bop_models(const std::filesystem::path& folder, const std::vector<BopModel>& models);

}  // namespace laterna
