// A block of samples, packed: a tar file for training, and a listing of what it holds.
#pragma once

#include "apps/lab/dataset/dataset_folder.h"

#include <nlohmann/json.hpp>

namespace laterna {

/// The checksum of a sample: SHA-256 of the lines that `sha256sum` prints of its files, in the order of their
/// names: (cd SAMPLE && find . -type f -printf '%P\n' | LC_ALL=C sort | xargs sha256sum | sha256sum).
///
/// Packs a block unless it is packed already, or is not whole yet: each file of sample KEY under the name
/// KEY.PATH with dots for slashes ("00000012.camera.projector.00.png"), so that WebDataset takes KEY as the
/// key and the rest as the kind. Whoever makes a block's last sample packs it; several may try at once.
/// Without `keep_folders` the samples' folders are removed then. Says whether the block is packed. Throws
/// InputError where something cannot be read or written.
bool pack_if_whole(const DatasetFolder& folder, std::uint64_t block, bool keep_folders);

/// What the block's listing says of each sample, in order: {"key", "sha256", "bytes", "files", "rejected"}.
nlohmann::json read_listing(const DatasetFolder& folder, std::uint64_t block);

}  // namespace laterna
