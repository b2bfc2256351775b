// Where a prim of OpenUSD stands in its parent: xformOpOrder and its operations.
//
//   xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ", ...]
//
// There matrices act on row vectors and the last operation of the list acts first, so that here
//   parent_from_prim = op_1 · op_2 · ... · op_n
// of column vectors. Operations, each with a suffix (":pivot") or "!invert!" before it or not: translate;
// rotateX, Y, Z and rotateXYZ, ... ZYX, in degrees, whose first letter acts first (rotateXYZ = Rz·Ry·Rx);
// orient, a quaternion w, x, y, z; transform, a rigid matrix whose last row is the translation; scale of 1
// alone. An operation that is not in the list does not act. Lengths become metres.
// https://openusd.org/release/api/class_usd_geom_xformable.html
#pragma once

#include "sim/rigid.h"

#include <map>
#include <string>
#include <vector>

namespace laterna {

/// The numbers of "((1, 0), (0, 1))", "[1, 2]" or "3". Throws InputError, beginning with `place`.
std::vector<double> usd_numbers(const std::string& value, const std::string& place);

/// `attributes`: a prim's, name to text. Throws InputError, beginning with `place` and the operation, for one
/// that is missing, not known, scales, or resets the parents' stack, and for operations without an order.
Rigid usd_parent_from_prim(const std::map<std::string, std::string>& attributes, double metres_per_unit,
                           const std::string& place);

}  // namespace laterna
