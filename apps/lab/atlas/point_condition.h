// Correspondences of a known projector under one condition of the atlas.
#pragma once

#include "calib/correspondences.h"
#include "sim/device.h"
#include "sim/fields.h"

#include <cstdint>
#include <string>

namespace laterna {

/// A projector of 1280×800 pixels that stands 2 m before points, and what is told of it.
struct PointCondition {
  double relief = 0.3;                    ///< thickness of the points' slab over their distance
  std::string shape = "slab";             ///< slab, two_planes, plane_and_line, twisted_cubic
  double grazing_deg = 65;                ///< between the slab's plane and the axis
  double throw_deg = 40;                  ///< angle across the picture's width
  double shift = 0.5;                     ///< of the principal point below the middle, in picture heights
  std::string orientation = "landscape";  ///< landscape, portrait, upside_down, mirrored
  int points = 500;
  double noise_px = 0.2;
  double outliers = 0;  ///< share of pixels that are anywhere
  double overlap =
      1;  ///< share of the picture's width and height that has points, from its upper left corner
  double world_offset_m = 0;     ///< of everything from the world's origin
  double true_k1 = 0;            ///< radial distortion of the projector
  std::string lens = "pinhole";  ///< that is solved for: pinhole, opencv4
  std::string loss = "none";     ///< none, huber, cauchy
  double shift_u_px = 0;         ///< of every pixel, and
  double world_scale = 1;        ///< of every point, unknown to the solver: no data can tell
};

template <class Visitor>
void describe(Visitor& visit, PointCondition& c) {
  visit(Field{.key = "relief", .low = 0, .high = 3}, c.relief);
  visit(Field{.key = "shape"}, c.shape);
  visit(Field{.key = "grazing_deg", .unit = "deg", .low = 0.1, .high = 90}, c.grazing_deg);
  visit(Field{.key = "throw_deg", .unit = "deg", .low = 0.01, .high = 170}, c.throw_deg);
  visit(Field{.key = "shift", .low = -5, .high = 5}, c.shift);
  visit(Field{.key = "orientation"}, c.orientation);
  visit(Field{.key = "points", .low = 1, .high = 1e7}, c.points);
  visit(Field{.key = "noise_px", .unit = "px", .low = 0, .high = 100}, c.noise_px);
  visit(Field{.key = "outliers", .low = 0, .high = 1}, c.outliers);
  visit(Field{.key = "overlap", .low = 0, .high = 1, .low_excluded = true}, c.overlap);
  visit(Field{.key = "world_offset_m", .unit = "m", .low = 0, .high = 1e9}, c.world_offset_m);
  visit(Field{.key = "true_k1", .low = -1, .high = 1}, c.true_k1);
  visit(Field{.key = "lens"}, c.lens);
  visit(Field{.key = "loss"}, c.loss);
  visit(Field{.key = "shift_u_px", .unit = "px", .low = -1e4, .high = 1e4}, c.shift_u_px);
  visit(Field{.key = "world_scale", .low = 0.01, .high = 100}, c.world_scale);
}

/// What a solver gets, and what is true.
struct PointProblem {
  Device truth;
  Correspondences correspondences;
  LargeVector<glm::dvec3> lit_points;  ///< true world points, for the volume
};

/// Points on pixels drawn evenly over the lit part of the picture, at depths of the condition's shape:
///
///   slab            a plane at 2 m, tilted, ± half the thickness
///   two_planes      the same with every other point on a second plane, tilted the other way
///   plane_and_line  half of the points on the plane (± relief), half within relief of one ray: with relief 0
///   both lie on
///                   the plane and a line through the projector's centre, from which no projector can be told
///   twisted_cubic   near a twisted cubic through the projector's centre, by relief (Hartley and
///   Zisserman, 22.1.2)
///
/// Sigmas are told as they are, at least 1e-3 px. The same seed gives the same problem. Throws InputError for
/// an unknown word.
PointProblem point_problem(const PointCondition& condition, std::uint64_t seed);

/// The Cramér-Rao bound of the volume error at the truth: what noise alone does to a solver that knows which
/// pixels are outliers and solves for the told lens. NaN where the told lens cannot be the true one, or the
/// points do not determine the projector.
double volume_bound_px(const PointProblem& problem, const PointCondition& condition);

}  // namespace laterna
