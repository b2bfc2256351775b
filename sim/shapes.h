// Small meshes that Laterna makes itself.
//
// All are centred at the origin, in metres, with texture coordinates and z up, out of the plane: seen from
// +z, with x to the right and y up, flat shapes show their front and the whole picture upright.
#pragma once

#include "sim/mesh.h"

#include <cstdint>
#include <string>

namespace laterna {

/// The rectangle |x| ≤ width/2, |y| ≤ height/2, z = 0, of columns × rows cells, two triangles each.
/// (s, t) = (x/width + 1/2, y/height + 1/2).
Mesh plane(double width, double height, int columns = 1, int rows = 1);

/// The box |x_i| ≤ size_i/2, twelve triangles, fronts outwards, or inwards (a room). Closed: triangles of two
/// faces meet in corners of exactly equal positions, which are not shared since each face carries the whole
/// picture.
Mesh box(const glm::dvec3& size, bool inward = false);

/// A sphere of subdivisions + 1 bands of latitude (the poles are ±z) times 2·(subdivisions + 1) of longitude,
/// its vertices on the sphere to the last bits, fronts outwards. Closed as the box is: along the seam of the
/// picture (the meridian through +x) and at the poles, several vertices have exactly equal positions. s =
/// longitude/2π, counted from +x towards +y; t = latitude/π + 1/2. subdivisions = 1 is the octahedron.
Mesh sphere(double radius, int subdivisions);

/// A smooth bumpy height field over plane(width, height, columns, rows), made to calibrate a projector on:
/// strong broad relief for the focal length, small features on top. z is the sum of 32 cosine waves, of
/// wavelengths from the longer side down to a sixteenth of it, in directions and phases drawn from `seed`;
/// amplitude is proportional to wavelength. It is scaled so that the vertices span exactly [-depth/2,
/// depth/2]. The same seed gives the same surface on any platform, to rounding.
Mesh relief(double width, double height, double depth, int columns, int rows, std::uint64_t seed = 1);

/// Two flat flanks that fall from x = ±width/2 to a line along y at x = 0 and include `opening_deg`, in (0,
/// 180), seen from +z. Its depth is width/2 / tan(opening/2), half of it below z = 0. (s, t) as on the plane.
Mesh v_groove(double width, double height, double opening_deg);

/// A shape by its name, as a scene file asks for it.
///
/// | shape | size | detail |
/// |---|---|---|
/// | plane | width, height, unused | columns and rows |
/// | box | width, height, depth | unused |
/// | sphere | the diameter, three times | subdivisions |
/// | relief | width, height, depth | columns and rows |
/// | v_groove | width, height, depth | unused |
struct ShapeSpec {
  std::string shape;
  glm::dvec3 size{1, 1, 1};  ///< metres, along x, y, z
  int detail = 64;           ///< 1 to 4096
  std::uint64_t seed = 1;    ///< of the relief
};

/// Throws InputError for an unknown name (listing the known ones), a size that is used and not finite and
/// above 0, a sphere of unequal diameters, or a detail out of range. The functions above throw it likewise.
Mesh make_shape(const ShapeSpec& spec);

}  // namespace laterna
