// laterna-mesh-reader FILE: reads a mesh in another format than PLY with Assimp and writes it to standard
// output as PLY, in doubles. Importers of many formats fail in many ways, so they run in this process, with
// limits: what happens here is a clear sentence in sim/mesh_file.cpp. Exit codes: 0 done; 2 the file is
// refused, the sentence stands on standard error; 3 memory ran out.
#include "sim/codec/assimp_mesh.h"
#include "sim/error.h"
#include "sim/gzip.h"
#include "sim/mesh_bytes.h"
#include "sim/ply.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <new>

namespace laterna {

namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limits_memory = false;  // a sanitizer's own tables are larger than any limit
#else
constexpr bool limits_memory = true;
#endif

void limit(__rlimit_resource what, rlim_t most) {
  rlimit now{};
  ::getrlimit(what, &now);
  now.rlim_cur = std::min(now.rlim_max, most);
  ::setrlimit(what, &now);
}

/// Seconds and memory by the size of the file (sim/mesh_file.h).
void limit_by_size(std::size_t bytes) {
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, 20 + bytes / 100'000);
  if (limits_memory) limit(RLIMIT_DATA, (std::size_t(1) << 30) + 64 * bytes);
}

/// Assimp takes an IFC file that was cut short as fine.
void expect_whole_ifc(std::string_view bytes, const std::string& name) {
  const std::string_view tail = bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 1024));
  if (tail.find("END-ISO-10303-21") != tail.npos) return;
  throw InputError(name + ": does not end with `END-ISO-10303-21;`: the file is truncated or no IFC file");
}

void expect_known(const std::string& extension, const std::string& name) {
  if (assimp_reads(extension)) return;
  throw InputError(
      fmt::format("{}: the ending `{}` is no mesh format that is known, expected .ply, .obj, .stl, .off, "
                  ".gltf, .glb, .ifc, .dae, .fbx, .3ds or another that Assimp reads, or one of them with "
                  ".gz",
                  name, extension));
}

Mesh read(const std::filesystem::path& path) {
  const std::string name = path.string();
  const MeshEnding ending = mesh_ending(path);
  expect_known(ending.extension, name);
  expect_mesh_file(path);
  limit_by_size(std::filesystem::file_size(path));
  // Formats may refer to files beside them (glTF to its buffers), so Assimp has to know the path; IFC does
  // not.
  if (!ending.packed && ending.extension != ".ifc") return read_with_assimp(path, ending.extension);
  const std::string bytes = unpacked_bytes(path, ending.packed);
  limit_by_size(bytes.size());
  if (ending.extension == ".ifc") expect_whole_ifc(bytes, name);
  return read_with_assimp(bytes, ending.extension, name);
}

}  // namespace

}  // namespace laterna

int main(int count, char** words) {
  if (count != 2) {
    std::fputs("usage: laterna-mesh-reader FILE, which laterna calls for itself\n", stderr);
    return 2;
  }
  try {
    const std::filesystem::path path = words[1];
    const laterna::Mesh mesh = laterna::read(path);
    laterna::validate(mesh, path.string());
    const std::string bytes = laterna::ply_bytes(mesh);
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0 ? 0
                                                                                                          : 1;
  } catch (const laterna::InputError& error) {
    std::fputs(error.what(), stderr);
    return 2;
  } catch (const std::bad_alloc&) {
    return 3;
  } catch (const std::exception& error) {
    std::fputs(error.what(), stderr);
    return 1;
  }
}
