#include "sim/mesh_file.h"

#include "sim/child_process.h"
#include "sim/error.h"
#include "sim/mesh_bytes.h"
#include "sim/ply.h"
#include "sim/run_path.h"

#include <fmt/format.h>

#include <csignal>
#include <utility>

namespace laterna {

namespace {

/// What the mesh reader's process ended with, in a sentence about the file.
[[noreturn]] void refuse(const ChildOutcome& ended, const MeshEnding& ending, const std::string& name) {
  const std::string reader = fmt::format("Assimp's {} reader", ending.extension);
  if (ended.exit_code == 2) throw InputError(ended.errors);
  if (ended.exit_code == 3)
    throw InputError(
        fmt::format("{}: {} asks for more memory than a file of this size may need: it is damaged or "
                    "hostile",
                    name, reader));
  if (ended.signal == SIGXCPU)
    throw InputError(
        fmt::format("{}: {} works on it for longer than a file of this size may take: it is damaged or "
                    "hostile",
                    name, reader));
  if (ended.signal != 0)
    throw InputError(
        fmt::format("{}: {} crashes on it (signal {}): it is damaged, or holds what that reader does not "
                    "master",
                    name, reader, ended.signal));
  throw InputError(fmt::format("{}: {} fails on it: {}", name, reader, ended.errors));
}

Mesh read_in_child(const std::filesystem::path& path, const MeshEnding& ending) {
  const ChildOutcome ended = run_child(find_on_run_path("laterna-mesh-reader"), {path.string()});
  if (ended.exit_code != 0 || ended.signal != 0) refuse(ended, ending, path.string());
  return read_ply(ended.output, path.string());
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path) {
  const MeshEnding ending = mesh_ending(path);
  if (ending.extension != ".ply") return read_in_child(path, ending);
  expect_mesh_file(path);
  Mesh mesh = read_ply(unpacked_bytes(path, ending.packed), path.string());
  validate(mesh, path.string());
  return mesh;
}

double metres_per_unit(const std::string& unit) {
  static constexpr std::pair<std::string_view, double> units[] = {
      {"m", 1.0}, {"mm", 1e-3}, {"cm", 1e-2}, {"km", 1e3}, {"inch", 0.0254}, {"foot", 0.3048}};
  std::string accepted;
  for (const auto& [name, metres] : units) {
    if (unit == name) return metres;
    accepted += fmt::format("{}\"{}\"", accepted.empty() ? "" : ", ", name);
  }
  throw InputError(fmt::format("unit \"{}\" is not known, expected one of {}", unit, accepted));
}

}  // namespace laterna
