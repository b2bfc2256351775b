// One sample of a data set: drawn, looked at, captured.
#pragma once

#include "apps/lab/dataset/sample_record.h"

#include <filesystem>

namespace laterna {

/// Makes sample `index` in the new folder `target` (dataset_folder.h), which is there only when whole. Draws
/// scenes until the rig sees enough of its light. The bytes depend on specification, seed and index alone.
/// Throws InputError, beginning with the sample's key, where the scene is not sound, every attempt is thrown
/// away, or the folder cannot be written.
void make_sample(const DatasetSpec& spec, std::uint64_t seed, std::uint64_t index,
                 const std::filesystem::path& target);

}  // namespace laterna
