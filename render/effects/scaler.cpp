#include "render/effects/scaler.h"

#include "render/projective_lookup.h"
#include "sim/effect_checks.h"
#include "sim/parallel.h"

#include <cmath>

namespace laterna {

namespace {

// From (0, 0), (1, 0), (1, 1), (0, 1) to the four corners; after Heckbert, "Fundamentals of texture mapping
// and image warping", 1989.
glm::dmat3 quadrilateral_from_square(const std::array<glm::dvec2, 4>& c) {
  const glm::dvec2 d1 = c[1] - c[2], d2 = c[3] - c[2], s = c[0] - c[1] + c[2] - c[3];
  const double area = d1.x * d2.y - d2.x * d1.y;
  const double g = (s.x * d2.y - d2.x * s.y) / area, h = (d1.x * s.y - s.x * d1.y) / area;
  return {glm::dvec3(c[1] - c[0] + g * c[1], g), glm::dvec3(c[3] - c[0] + h * c[3], h), glm::dvec3(c[0], 1)};
}

// Scale first, then move.
glm::dmat3 affine(const glm::dvec2& scale, const glm::dvec2& move) {
  return {{scale.x, 0, 0}, {0, scale.y, 0}, {move.x, move.y, 1}};
}

struct Reader {
  const PatternStack& input;
  bool nearest;

  void operator()(const glm::dvec2& at, std::uint8_t* out) const {
    if (nearest) {
      std::copy_n(input.texel(nearest_texel(at.x, input.width), nearest_texel(at.y, input.height)),
                  input.count, out);
      return;
    }
    const LinearTaps x = linear_taps(at.x, input.width), y = linear_taps(at.y, input.height);
    const std::uint8_t *a = input.texel(x.first, y.first), *b = input.texel(x.second, y.first),
                       *c = input.texel(x.first, y.second), *d = input.texel(x.second, y.second);
    for (int k = 0; k < input.count; ++k) {
      const double upper = a[k] + x.share * (b[k] - a[k]), lower = c[k] + x.share * (d[k] - c[k]);
      out[k] = std::uint8_t(upper + y.share * (lower - upper) + 0.5);
    }
  }
};

}  // namespace

glm::ivec2 input_size(const Effects& effects, const Projector& projector) {
  const glm::ivec2 panel = projector.device.intrinsics.size;
  return effects.scaler ? projector.effects.scaler.input_size.value_or(panel) : panel;
}

glm::dmat3 input_from_panel(const Scaler& scaler, const glm::ivec2& input_px, const glm::ivec2& panel_px) {
  const glm::dvec2 panel(panel_px), input(input_px);
  const glm::dmat3 unit_from_panel = affine(1.0 / panel, 0.5 / panel);
  const glm::dmat3 keystone = quadrilateral_from_square(keystone_corners(scaler));
  const double shown = 1 - scaler.overscan;
  const glm::dmat3 input_from_unit = affine(input * shown, input * (scaler.overscan / 2) - 0.5);
  const glm::dmat3 h = input_from_unit * glm::inverse(keystone) * unit_from_panel;
  const glm::dvec3 middle = keystone * glm::dvec3(0.5, 0.5, 1);
  const glm::dvec2 middle_px = glm::dvec2(middle) / middle.z * panel - 0.5;
  return (h * glm::dvec3(middle_px, 1)).z < 0 ? -1.0 * h : h;
}

PatternStack scale_patterns(const PatternStack& input, const Scaler& scaler, const glm::ivec2& panel_px) {
  const glm::ivec2 size(input.width, input.height);
  const glm::dmat3 h = input_from_panel(scaler, size, panel_px);
  const Reader read{input, scaler.lookup == Lookup::nearest};
  PatternStack panel{panel_px.x, panel_px.y, input.count, {}, input.light_of_value, input.added_light};
  panel.values.assign(std::size_t(panel.width) * panel.height * panel.count, 0);
  // 1e-9 px: an edge that falls on pixel borders keeps its pixels under rounding.
  const auto inside = [](double u, int n) { return u >= -0.5 - 1e-9 && u <= n - 0.5 + 1e-9; };
  parallel_for(std::size_t(panel.height), [&](std::size_t y) {
    std::uint8_t* out = panel.values.data() + y * panel.width * panel.count;
    for (int x = 0; x < panel.width; ++x, out += panel.count) {
      const glm::dvec3 q = h * glm::dvec3(x, double(y), 1);
      const glm::dvec2 at = glm::dvec2(q) / q.z;
      if (q.z > 0 && inside(at.x, size.x) && inside(at.y, size.y)) read(at, out);
    }
  });
  return panel;
}

}  // namespace laterna
