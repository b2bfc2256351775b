// What a solver is told that each camera pixel sees: the believed meshes, met by the believed cameras' rays.
#pragma once

#include "apps/lab/simulation.h"
#include "calib/correspondences.h"

#include <vector>

namespace laterna {

/// Of one camera.
struct ToldPoints {
  PixelArray<glm::dvec3> points_world;   ///< m; NaN where the believed ray misses the believed meshes
  PixelArray<glm::dvec3> normals_world;  ///< unit; 0 where it misses. Empty where all cameras are certain
};

/// The scene's cameras as a solver is told of them, each with its covariance (sim/believed.h). Empty where
/// all of them are certain.
std::vector<UncertainCamera> told_cameras(const Scene& scene);

/// The scene as a solver is told of it, ready for the rays of its cameras: displaced first, then believed().
class ToldScene {
 public:
  explicit ToldScene(const Scene& scene);
  const Scene& scene() const { return *told_; }
  ToldPoints trace(int camera) const;

  ToldScene(const ToldScene&) = delete;  // it points into itself
  ToldScene& operator=(const ToldScene&) = delete;

 private:
  std::optional<Scene> displaced_, believed_;
  const Scene* told_;
  RayScene rays_;
  bool certain_;
};

/// One per camera. Where nothing is believed otherwise no ray is traced again: the points are those of
/// `traced`.
std::vector<ToldPoints> told_points(const Scene& scene, const Traced& traced);

}  // namespace laterna
