// A mesh that is accepted is written and read back the same.
#include "sim/ply.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t count) {
  using namespace laterna;
  return fuzz::attempt([&] {
    const Mesh mesh = read_ply(fuzz::text_of(bytes, count), "fuzz.ply");
    validate(mesh, "fuzz.ply");
    const Mesh again = read_ply(ply_bytes(mesh), "again.ply");
    fuzz::expect(again.positions == mesh.positions && again.triangles == mesh.triangles &&
                     again.texture_coordinates == mesh.texture_coordinates,
                 "read(write(mesh)) is the mesh");
  });
}
