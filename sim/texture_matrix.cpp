#include "sim/texture_matrix.h"

#include "sim/error.h"
#include "sim/rq.h"

#include <fmt/format.h>

#include <cmath>

namespace laterna {

namespace {

// GLM stores columns; this takes a matrix the way it is written on paper.
glm::dmat4 from_rows(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c, const glm::dvec4& d) {
  return glm::transpose(glm::dmat4(a, b, c, d));
}

glm::dvec4 row(const glm::dmat4& m, int i) { return {m[0][i], m[1][i], m[2][i], m[3][i]}; }

}  // namespace

void validate(const LightPlanes& planes, const char* what) {
  for (const auto& plane : {planes.near_m, planes.far_m}) {
    if (plane && !(*plane > 0 && std::isfinite(*plane))) {
      throw InputError(
          fmt::format("{}: a light plane lies at {} m, expected a positive distance", what, *plane));
    }
  }
  if (planes.near_m && planes.far_m && *planes.near_m >= *planes.far_m) {
    throw InputError(fmt::format("{}: near is {} and far is {}, expected near < far", what, *planes.near_m,
                                 *planes.far_m));
  }
}

glm::dmat4 texture_from_clip() {
  return from_rows({0.5, 0, 0, 0.5}, {0, 0.5, 0, 0.5}, {0, 0, 0.5, 0.5}, {0, 0, 0, 1});
}

glm::dmat4 clip_from_projector(const Intrinsics& k, const LightPlanes& planes) {
  const double w = k.size.x, h = k.size.y;
  double n = planes.near_m.value_or(default_near_m);
  if (planes.far_m && !planes.near_m) n = std::min(n, *planes.far_m / 2);
  double depth_scale = -1, depth_bias = -2 * n;  // far plane at infinity
  if (planes.far_m) {
    const double f = *planes.far_m;
    depth_scale = -(f + n) / (f - n);
    depth_bias = -2 * f * n / (f - n);
  }
  return from_rows({2 * k.fx / w, 0, 1 - 2 * (k.cx + 0.5) / w, 0},  //
                   {0, 2 * k.fy / h, 2 * (k.cy + 0.5) / h - 1, 0},  //
                   {0, 0, depth_scale, depth_bias},                 //
                   {0, 0, -1, 0});
}

glm::dmat4 projector_from_world(const Rigid& device_from_world) {
  const glm::dmat4 flip(glm::dvec4(1, 0, 0, 0), glm::dvec4(0, -1, 0, 0), glm::dvec4(0, 0, -1, 0),
                        glm::dvec4(0, 0, 0, 1));
  return flip * matrix_of(device_from_world);
}

glm::dmat4 texture_from_object(const Intrinsics& intrinsics, const LightPlanes& planes,
                               const Rigid& device_from_world, const glm::dmat4& world_from_object) {
  return (texture_from_clip() * clip_from_projector(intrinsics, planes)) *
         (projector_from_world(device_from_world) * world_from_object);
}

glm::dvec2 pixel_from_texture(const glm::dvec4& strq, glm::ivec2 size) {
  return {strq.x / strq.w * size.x - 0.5, (1 - strq.y / strq.w) * size.y - 0.5};
}

glm::dvec2 texture_from_pixel(const glm::dvec2& pixel, glm::ivec2 size) {
  return {(pixel.x + 0.5) / size.x, 1 - (pixel.y + 0.5) / size.y};
}

glm::dmat4x3 pixel_from_object(const glm::dmat4& t, glm::ivec2 size) {
  const glm::dvec4 q = row(t, 3);
  const glm::dvec4 u = row(t, 0) * double(size.x) - 0.5 * q;
  const glm::dvec4 v = (q - row(t, 1)) * double(size.y) - 0.5 * q;
  return glm::transpose(glm::dmat3x4(u, v, q));
}

TextureMatrixParts decompose(const glm::dmat4& texture_from_world, glm::ivec2 size) {
  const glm::dmat4x3 a = pixel_from_object(texture_from_world, size);
  const double det = glm::determinant(glm::dmat3(a));
  const glm::dmat3x4 rows = glm::transpose(a);
  const double volume =
      glm::length(glm::dvec3(rows[0])) * glm::length(glm::dvec3(rows[1])) * glm::length(glm::dvec3(rows[2]));
  if (!std::isfinite(det) || !(std::abs(det) > 1e-14 * volume)) {
    throw InputError(
        "texture matrix: its left 3×3 block is singular, expected a projection with a finite centre");
  }
  const KAndR parts = k_and_r(glm::dmat3(a), size);
  const Intrinsics& k = parts.intrinsics;
  const glm::dvec3 b = a[3] / parts.scale;  // K·t
  const double ty = (b.y - k.cy * b.z) / k.fy;
  const glm::dvec3 t((b.x - parts.skew_px * ty - k.cx * b.z) / k.fx, ty, b.z);
  return {k, {parts.rotation, t}, parts.skew_px};
}

}  // namespace laterna
