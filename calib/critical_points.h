// Points from which a single view hardly tells its place and intrinsics, though they are no plane.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <string>

namespace laterna {

enum class CriticalSet { none, twisted_cubic, plane_and_line };

/// What the points lie on, or within a tenth of their spread along each principal axis: a twisted cubic, on
/// which three independent quadrics meet, or a plane and a line, which two pairs of planes share (Hartley and
/// Zisserman, Multiple View Geometry, 22.1: with the centre on the cubic, or on the line, a projective camera
/// is not unique; square pixels tell more of the second). Both are the same sets under affine maps, so the
/// points are taken with spread 1 along each axis. None for fewer than 12 points, or exactly flat ones.
CriticalSet critical_set(std::span<const glm::dvec3> points);

/// "the points lie near a critical curve: ..."; empty for none. Say it where the solution has been found not
/// to be unique: that the centre lies on the set is taken from there.
std::string critical_in_words(CriticalSet set);

}  // namespace laterna
