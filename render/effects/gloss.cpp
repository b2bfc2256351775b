#include "render/effects/gloss.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

constexpr double pi = std::numbers::pi;

double phong(double exponent, const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v) {
  const double mirrored = glm::dot(2 * glm::dot(n, l) * n - l, v);
  return mirrored > 0 ? (exponent + 2) / (2 * pi) * std::pow(mirrored, exponent) : 0;
}

double ggx(double alpha, const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v) {
  const double nl = glm::dot(n, l), nv = glm::dot(n, v), nh = glm::dot(n, glm::normalize(l + v));
  const double a2 = alpha * alpha, base = nh * nh * (a2 - 1) + 1;
  const double d = a2 / (pi * base * base);
  const double visible =
      0.5 / (nl * std::sqrt(a2 + (1 - a2) * nv * nv) + nv * std::sqrt(a2 + (1 - a2) * nl * nl));
  return d * visible;  // G/(4·nl·nv) in one term
}

}  // namespace

double gloss_per_sr(const Gloss& gloss, const glm::dvec3& n, const glm::dvec3& l, const glm::dvec3& v) {
  if (!(glm::dot(n, l) > 0) || !(glm::dot(n, v) > 0)) return 0;
  if (gloss.model == GlossModel::phong) return gloss.strength * phong(*gloss.exponent, n, l, v);
  if (gloss.model == GlossModel::ggx) return gloss.strength * ggx(*gloss.roughness, n, l, v);
  return 0;
}

void make_room_for_gloss(SurfaceMap& surface, const Scene& scene) {
  for (std::size_t p = 0; p < surface.albedo.values.size(); ++p) {
    if (!surface.hit(p) || !surface.seen_front.values[p]) continue;
    if (scene.objects[surface.object.values[p]].effects.gloss.model == GlossModel::none) continue;
    surface.albedo.values[p] = std::max(surface.albedo.values[p], least_glossy_albedo);
  }
}

void apply_gloss(LightMap& light, const PixelGeometry& geometry, const Projector& projector,
                 const Camera& camera) {
  const glm::dvec3 from = geometry.center(projector.device), eye = geometry.center(camera.device);
  weigh(light, [&](std::size_t p) {
    const Gloss& gloss = geometry.object(p).effects.gloss;
    const double albedo = geometry.surface().albedo.values[p];
    if (gloss.model == GlossModel::none || !(albedo > 0)) return 1.0;
    const glm::dvec3 x = geometry.point(p), l = glm::normalize(from - x), v = glm::normalize(eye - x);
    const glm::dvec3 n = geometry.normal(p);
    const bool from_behind = glm::dot(geometry.flat_normal(p), l) < 0;  // with back_face off
    return 1 + pi * gloss_per_sr(gloss, from_behind ? -n : n, l, v) / albedo;
  });
}

}  // namespace laterna
