// A picture in several passes through a frame buffer, object by object.
#pragma once

#include "render/classic/frame_buffer.h"
#include "render/classic/slide_lookup.h"
#include "render/classic/texture_coordinates.h"
#include "render/ray_scene.h"
#include "sim/scene.h"

#include <functional>
#include <vector>

namespace laterna {

/// What the camera sees of each object as if it stood alone: a rasteriser's fragments.
struct Fragments {
  struct OfObject {
    Scene scene;  ///< with the one object
    SurfaceMap surface;
    PixelArray<glm::dvec3> points_world, normals_world;
  };
  std::vector<OfObject> objects;
  glm::ivec2 size{0, 0};
  explicit Fragments(const Scene& scene);
};

/// The share of a light's white that a fragment gets; empty where it is killed.
using LightShade = std::function<std::optional<double>(const Fragments::OfObject&, std::size_t p)>;

struct PassOptions {
  double ambient = 0;                ///< what pass 1 draws
  std::vector<LightShade> lights{};  ///< of pass 2, one after the other
  bool depth_again = true;           ///< pass 3
  bool surface_texture = true;       ///< pass 4
  int steps = 0;                     ///< FrameBuffer's
};

/// The frame buffer after each pass:
///
///   1  ambient light and depth, where it is nearer
///   2  each light added where depth is equal
///   3  (depth_again) the depth cleared and drawn anew, no colour
///   4  multiplied by the surface's texture where depth is equal
///
/// in shares of the white of a surface of the object's plain albedo.
std::vector<Image<double>> draw_passes(const Fragments& fragments, const PassOptions& options);

/// A projector's slide as a fragment's light.
struct SlideOptions {
  CoordinateSource coordinates = CoordinateSource::object_linear;
  FragmentTests tests{};
  Wrap wrap = Wrap::clamp_to_edge;
  double share = 1;       ///< of the frame buffer's 1 that the slide's white gets
  bool back_face = true;  ///< whether the projector must stand on the fragment's front side
};
LightShade slide_shade(const Fragments& fragments, const Projector& projector, const Image<float>& slide,
                       const SlideOptions& options);

/// Whether the projector is on the front side of what a fragment shows.
bool faces(const Fragments::OfObject& object, std::size_t p, const Projector& projector);

}  // namespace laterna
