#include "apps/lab/classics/spot_passes.h"

#include <map>
#include <memory>

namespace laterna {

double spot_at(const Projector& projector, const glm::dvec3& x_world) {
  const glm::dvec3 x = apply(projector.device.device_from_world, x_world);
  if (!(x.z > 0)) return 0;
  return cone_intensity(projector.effects.spotlight, glm::dvec2(x) / x.z) *
         attenuation_at(projector, glm::length(x));
}

namespace {

/// A spotlight ready to be looked up.
struct Spot {
  const Projector& projector;
  SpotOptions options;
  Image<float> map;
  AttenuationTexture volume;
  std::map<const Fragments::OfObject*, PixelArray<glm::dvec4>> coordinates;

  double light(const glm::dvec4& strq, const glm::dvec3& x_world) const {
    const glm::dvec3 str = glm::dvec3(strq) / strq.w;
    const double cone = options.map_texels > 0 ? slide_value(map, strq, Lookup::bilinear, options.wrap)
                                               : cone_intensity(projector.effects.spotlight,
                                                                slope_of(projector.device.intrinsics, str));
    if (options.volume_texels > 0) return cone * volume.value(str);
    return cone * attenuation_at(projector, glm::length(apply(projector.device.device_from_world, x_world)));
  }
};

}  // namespace

LightShade spot_shade(const Fragments& fragments, const Projector& projector, const SpotOptions& options) {
  auto spot = std::make_shared<Spot>(Spot{projector, options, {}, {}, {}});
  if (options.map_texels > 0) spot->map = intensity_map(projector, options.map_texels);
  if (options.volume_texels > 0)
    spot->volume = attenuation_texture(projector, glm::ivec3(options.volume_texels), options.index);
  if (options.map_texels == 0) spot->options.tests.st = true;
  for (const auto& object : fragments.objects)
    spot->coordinates[&object] = texture_coordinates(object.surface, object.scene, object.scene.cameras[0],
                                                     projector, CoordinateSource::object_linear);
  return [spot](const Fragments::OfObject& object, std::size_t p) -> std::optional<double> {
    const glm::dvec4 strq = spot->coordinates.at(&object).values[p];
    if (!survives(strq, spot->options.tests) || !faces(object, p, spot->projector)) return {};
    return spot->light(strq, object.points_world.values[p]);
  };
}

}  // namespace laterna
