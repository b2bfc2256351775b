#include "render/classic/texture_coordinates.h"

#include "render/classic/vertex_values.h"

#include <limits>

namespace laterna {

namespace {

/// What an object's coordinates are generated from.
struct ObjectCoordinates {
  glm::dmat4 texture_from_object, eye_from_object, texture_from_eye;
  std::vector<glm::dvec4> of_vertex;
};

ObjectCoordinates coordinates_of(const Object& object, const Camera& camera, const Projector& projector) {
  const Device& light = projector.device;
  ObjectCoordinates c;
  c.texture_from_object =
      texture_from_object(light.intrinsics, light.planes, light.device_from_world, object.world_from_object);
  const glm::dmat4 eye_from_world = projector_from_world(camera.device.device_from_world);
  c.eye_from_object = eye_from_world * object.world_from_object;
  c.texture_from_eye = texture_from_world(light) * glm::inverse(eye_from_world);
  for (const glm::dvec3& x : object.mesh.positions)
    c.of_vertex.push_back(c.texture_from_object * glm::dvec4(x, 1));
  return c;
}

}  // namespace

PixelArray<glm::dvec4> texture_coordinates(const SurfaceMap& surface, const Scene& scene,
                                           const Camera& camera, const Projector& projector,
                                           CoordinateSource source) {
  std::vector<ObjectCoordinates> objects;
  for (const Object& object : scene.objects) objects.push_back(coordinates_of(object, camera, projector));
  PixelArray<glm::dvec4> strq(surface.width, surface.height);
  for (std::size_t p = 0; p < strq.values.size(); ++p) {
    strq.values[p] = glm::dvec4(std::numeric_limits<double>::quiet_NaN());
    if (!surface.hit(p)) continue;
    const std::uint32_t k = surface.object.values[p];
    const ObjectCoordinates& c = objects[k];
    const glm::dvec4 x(surface.point_object.values[p], 1);
    if (source == CoordinateSource::object_linear) strq.values[p] = c.texture_from_object * x;
    if (source == CoordinateSource::eye_linear) strq.values[p] = c.texture_from_eye * (c.eye_from_object * x);
    if (source == CoordinateSource::given)
      strq.values[p] = vertex_value(scene.objects[k].mesh, c.of_vertex, surface, p);
  }
  return strq;
}

}  // namespace laterna
