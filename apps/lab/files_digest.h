// Whether files are still what they were.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

/// SHA-256 over the bytes of all the files, whatever their order and however often one is named; "none" for
/// no files. Throws InputError where one cannot be read.
std::string files_digest(std::vector<std::filesystem::path> files);

}  // namespace laterna
