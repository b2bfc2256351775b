// Meshes of fewer triangles.
#pragma once

#include "sim/mesh.h"

namespace laterna {

/// The mesh with vertices of exactly equal position made one, and without texture coordinates.
Mesh welded(const Mesh& mesh);

/// At most about `keep` (0 to 1) of the triangles, by edge collapse under quadric errors (Garland and
/// Heckbert, SIGGRAPH 1997; meshoptimizer's meshopt_simplify). The vertices that stay keep their bits;
/// triangles keep their turn. More stay where collapsing further would change the topology or fold the
/// surface. `mesh` must be welded(). A mesh of which nothing would be left comes back as it is.
Mesh decimated(const Mesh& mesh, double keep);

}  // namespace laterna
