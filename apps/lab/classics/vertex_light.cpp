#include "apps/lab/classics/vertex_light.h"

#include "render/classic/vertex_values.h"
#include "render/triangle_planes.h"

namespace laterna {

Image<float> vertex_light(const SurfaceMap& surface, const Scene& scene,
                          const std::function<double(const glm::dvec3&)>& light_at) {
  std::vector<std::vector<double>> of_vertex;
  for (const Object& object : scene.objects) {
    std::vector<double> light;
    for (const glm::dvec3& x : world_positions(object)) light.push_back(light_at(x));
    of_vertex.push_back(std::move(light));
  }
  Image<float> image(surface.width, surface.height);
  for (std::size_t p = 0; p < image.values.size(); ++p) {
    if (!surface.hit(p)) continue;
    const std::uint32_t k = surface.object.values[p];
    image.values[p] = float(vertex_value(scene.objects[k].mesh, of_vertex[k], surface, p));
  }
  return image;
}

Image<float> sample_light(const SurfaceMap& surface, const Scene& scene,
                          const std::function<double(const glm::dvec3&)>& light_at) {
  const auto points = points_world(surface, scene);
  Image<float> image(surface.width, surface.height);
  for (std::size_t p = 0; p < image.values.size(); ++p)
    if (surface.hit(p)) image.values[p] = float(light_at(points.values[p]));
  return image;
}

}  // namespace laterna
