// The two programs of the rasteriser.
#pragma once

namespace laterna::gl {

inline constexpr char vertex_shader[] = R"(#version 330 core
layout(location = 0) in vec3 x_object;
layout(location = 1) in vec3 normal_world;
uniform mat4 clip_from_object, texture_from_object;
uniform mat4 ray_from_object;  // the point in world axes, seen from the projector
invariant gl_Position;
out vec4 strq;
out vec3 ray;
flat out vec3 normal;
void main() {
  gl_Position = clip_from_object * vec4(x_object, 1.0);
  strq = texture_from_object * vec4(x_object, 1.0);
  ray = (ray_from_object * vec4(x_object, 1.0)).xyz;
  normal = normal_world;
}
)";

inline constexpr char depth_shader[] = R"(#version 330 core
void main() {}
)";

// E = Φ·fx·fy·h/q³ with the projector's height h above the triangle's plane, or Φ·fx·fy: see
// render/direct_light.h. `gain` is all of it but h/q³, times albedo/π, over saturation.
inline constexpr char light_shader[] = R"(#version 330 core
uniform sampler2D slide;
uniform sampler2DShadow depth_map;
uniform vec2 size;
uniform float gain;
uniform bool border, back_face, irradiance, shadow;
in vec4 strq;
in vec3 ray;
flat in vec3 normal;
layout(location = 0) out float dn;
layout(location = 1) out float share;
layout(location = 2) out vec4 uvq1;
void main() {
  float q = strq.q;
  if (!(q > 0.0)) discard;
  vec2 st = strq.st / q;
  if (border && (any(lessThan(st, vec2(0.0))) || any(greaterThan(st, vec2(1.0))))) discard;
  float height = -dot(normal, ray);
  if (back_face && (!gl_FrontFacing || height <= 0.0)) discard;
  if (shadow && textureProj(depth_map, strq) < 0.5) discard;
  float weight = gain * (irradiance ? abs(height) / (q * q * q) : 1.0);
  share = weight * textureProj(slide, strq).r;
  dn = share;
  uvq1 = vec4(st.s * size.x - 0.5, (1.0 - st.t) * size.y - 0.5, q, 1.0);
}
)";

}  // namespace laterna::gl
