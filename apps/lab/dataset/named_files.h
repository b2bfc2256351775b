// The files that a data set may read.
#pragma once

#include "apps/lab/dataset/dataset_spec.h"

#include <filesystem>
#include <vector>

namespace laterna {

/// Every file that the scene or a distribution names, drawn or not: whatever string of either is the name of
/// a file, looked for in the scene's folder. In the order of scene and specification; may name one twice.
std::vector<std::filesystem::path> named_files(const DatasetSpec& spec);

}  // namespace laterna
