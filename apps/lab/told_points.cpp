#include "apps/lab/told_points.h"

#include "render/effects/displacement.h"
#include "sim/believed.h"

#include <algorithm>

namespace laterna {

std::vector<UncertainCamera> told_cameras(const Scene& scene) {
  std::vector<UncertainCamera> cameras;
  bool certain = true;
  for (const Camera& camera : scene.cameras) {
    cameras.push_back(
        {scene.believe_truth ? camera.device : believed_device(camera), told_covariance(scene, camera)});
    certain &= cameras.back().covariance.empty();
  }
  if (certain) cameras.clear();
  return cameras;
}

ToldScene::ToldScene(const Scene& scene)
    : told_(&believed(displaced(scene, displaced_), believed_)),
      rays_(*told_),
      certain_(told_cameras(scene).empty()) {}

ToldPoints ToldScene::trace(int camera) const {
  const SurfaceMap surface = trace_surface(rays_, *told_, told_->cameras[camera]);
  return {points_world(surface, *told_), certain_ ? PixelArray<glm::dvec3>() : normals_world(surface, rays_)};
}

std::vector<ToldPoints> told_points(const Scene& scene, const Traced& traced) {
  const auto differs = [&](const auto& noun) { return believed_otherwise(scene, noun); };
  std::optional<ToldScene> told;
  if (std::any_of(scene.objects.begin(), scene.objects.end(), differs) ||
      std::any_of(scene.cameras.begin(), scene.cameras.end(), differs))
    told.emplace(scene);
  const bool certain = told_cameras(scene).empty();
  std::vector<ToldPoints> points;
  for (int c = 0; c < int(scene.cameras.size()); ++c) {
    if (told)
      points.push_back(told->trace(c));
    else
      points.push_back({traced.points_world[c],
                        certain ? PixelArray<glm::dvec3>() : normals_world(traced.surfaces[c], traced.rays)});
  }
  return points;
}

}  // namespace laterna
