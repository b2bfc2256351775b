// The programs: depth for the shadow map; the picture; lines.

export const vertexShader = `#version 300 es
layout(location = 0) in vec3 x_object;
layout(location = 1) in vec3 normal_world;
uniform mat4 clip_from_object, texture_from_object, ray_from_object, eye_from_object;
out vec4 strq;
out vec3 ray, sight;
flat out vec3 normal;
void main() {
  vec4 x = vec4(x_object, 1.0);
  gl_Position = clip_from_object * x;
  strq = texture_from_object * x;
  ray = (ray_from_object * x).xyz;
  sight = (eye_from_object * x).xyz;
  normal = normal_world;
}`;

export const depthShader = `#version 300 es
void main() {}`;

// E = flux·fx·fy·h/q³, h the projector's height above the triangle's plane, as render/direct_light.h has it.
export const lightShader = `#version 300 es
precision highp float;
precision highp sampler2D;
precision highp sampler2DShadow;
uniform sampler2D slide;
uniform sampler2DShadow depth_map;
uniform float white, ambient, lamp;  // shares of saturation: white at 1 m, the ambient light, the lighting
uniform bool in_front, border, back_face, shadow, irradiance, for_people;
in vec4 strq;
in vec3 ray, sight;
flat in vec3 normal;
layout(location = 0) out vec4 picture;
vec3 projected(out float lit) {
  float q = strq.q, height = -dot(normal, ray);
  vec2 st = strq.st / q;
  vec3 texel = textureProj(slide, strq).rgb;
  bool shaded = shadow && q > 0.0 && textureProj(depth_map, strq) < 0.5;
  bool outside = border && (any(lessThan(st, vec2(0.0))) || any(greaterThan(st, vec2(1.0))));
  lit = float(!((in_front && !(q > 0.0)) || outside || (back_face && height <= 0.0) || shaded));
  return lit * texel * white * (irradiance ? abs(height) / abs(q * q * q) : 1.0);
}
void main() {
  float lit = 0.0;
  vec3 light = vec3(0.0);
  if (gl_FrontFacing || !back_face) light = projected(lit) + ambient;
  light += lamp * (0.25 + 0.75 * abs(dot(normal, normalize(sight))));
  if (for_people)  // the sRGB curve
    light = mix(12.92 * light, 1.055 * pow(light, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, light));
  picture = vec4(light, for_people ? 1.0 : lit);
}`;

export const lineShader = `#version 300 es
precision highp float;
layout(location = 0) out vec4 picture;
void main() { picture = vec4(1.0, 0.75, 0.2, 1.0); }`;
