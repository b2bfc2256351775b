#include "sim/run_path.h"

#include <dlfcn.h>
#include <link.h>

#include <cstddef>
#include <stdexcept>
#include <vector>

namespace laterna {

namespace {

/// The linker's record of whatever holds this function.
link_map* own_link_map() {
  Dl_info info{};
  void* map = nullptr;
  const void* here = reinterpret_cast<const void*>(&find_on_run_path);
  if (::dladdr1(here, &info, &map, RTLD_DL_LINKMAP) == 0)
    throw std::runtime_error("the dynamic linker does not know this program");
  return static_cast<link_map*>(map);
}

}  // namespace

std::filesystem::path find_on_run_path(const std::string& name) {
  link_map* map = own_link_map();
  Dl_serinfo size{};
  if (::dlinfo(map, RTLD_DI_SERINFOSIZE, &size) != 0) throw std::runtime_error(::dlerror());
  std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
  auto* found = reinterpret_cast<Dl_serinfo*>(memory.data());
  *found = size;
  if (::dlinfo(map, RTLD_DI_SERINFO, found) != 0) throw std::runtime_error(::dlerror());
  for (unsigned i = 0; i < found->dls_cnt; ++i) {
    std::filesystem::path file = std::filesystem::path(found->dls_serpath[i].dls_name) / name;
    if (std::filesystem::exists(file)) return file;
  }
  throw std::runtime_error("`" + name +
                           "`, a part of Laterna, is not where this program looks for its libraries");
}

}  // namespace laterna
