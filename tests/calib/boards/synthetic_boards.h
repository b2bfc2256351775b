// The library's synthetic boards under the tests' namespace.
#pragma once

#include "calib/boards/synthetic_boards.h"

namespace laterna::testing {

using namespace laterna::synthetic;  // NOLINT(google-build-using-namespace)

}  // namespace laterna::testing
