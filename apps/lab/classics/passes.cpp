#include "apps/lab/classics/passes.h"

#include <map>
#include <memory>

namespace laterna {

Fragments::Fragments(const Scene& scene) {
  for (const Object& object : scene.objects) {
    OfObject one{scene, {}, {}, {}};
    one.scene.objects = {object};
    const RayScene rays(one.scene);
    one.surface = trace_surface(rays, one.scene, scene.cameras[0]);
    one.points_world = points_world(one.surface, one.scene);
    one.normals_world = normals_world(one.surface, rays);
    objects.push_back(std::move(one));
  }
  size = scene.cameras[0].device.intrinsics.size;
}

std::vector<Image<double>> draw_passes(const Fragments& fragments, const PassOptions& options) {
  FrameBuffer buffer(fragments.size.x, fragments.size.y, options.steps);
  std::vector<Image<double>> after;
  const auto pass = [&](const Pass& how, const LightShade& shade) {
    for (const auto& object : fragments.objects)
      draw(buffer, object.surface, how, [&](std::size_t p) { return shade(object, p); });
  };
  const auto constant = [](double value) {
    return [value](const Fragments::OfObject&, std::size_t) { return std::optional(value); };
  };
  pass({DepthTest::less, Blend::replace}, constant(options.ambient));
  after.push_back(buffer.colour);
  for (const LightShade& light : options.lights) pass({DepthTest::equal, Blend::add}, light);
  after.push_back(buffer.colour);
  if (options.depth_again) {
    buffer.clear_depth();
    pass({DepthTest::less, Blend::keep}, constant(0));
    after.push_back(buffer.colour);
  }
  if (options.surface_texture) {
    pass({DepthTest::equal, Blend::multiply}, [](const Fragments::OfObject& object, std::size_t p) {
      return std::optional(double(object.surface.albedo.values[p]) / object.scene.objects[0].albedo);
    });
    after.push_back(buffer.colour);
  }
  return after;
}

bool faces(const Fragments::OfObject& object, std::size_t p, const Projector& projector) {
  const glm::dvec3 to_light =
      center_in_world(projector.device.device_from_world) - object.points_world.values[p];
  return glm::dot(object.normals_world.values[p], to_light) > 0;
}

LightShade slide_shade(const Fragments& fragments, const Projector& projector, const Image<float>& slide,
                       const SlideOptions& options) {
  auto coordinates = std::make_shared<std::map<const Fragments::OfObject*, PixelArray<glm::dvec4>>>();
  for (const auto& object : fragments.objects)
    (*coordinates)[&object] = texture_coordinates(object.surface, object.scene, object.scene.cameras[0],
                                                  projector, options.coordinates);
  return [coordinates, &projector, &slide, options](const Fragments::OfObject& object,
                                                    std::size_t p) -> std::optional<double> {
    const glm::dvec4 strq = coordinates->at(&object).values[p];
    if (!survives(strq, options.tests) || (options.back_face && !faces(object, p, projector))) return {};
    return options.share * slide_value(slide, strq, projector.lookup, options.wrap);
  };
}

}  // namespace laterna
