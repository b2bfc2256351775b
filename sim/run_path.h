// Files that belong to the program but stand in a folder of their own, as the modules and helper programs do.
#pragma once

#include <filesystem>
#include <string>

namespace laterna {

/// The first file called `name` in the folders where the dynamic linker looks for this code's libraries: the
/// run path of the program or of the shared library that this function was linked into, in the build folder
/// as after installation (dlinfo(3), RTLD_DI_SERINFO). Throws std::runtime_error where none has it.
std::filesystem::path find_on_run_path(const std::string& name);

}  // namespace laterna
