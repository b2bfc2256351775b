// Prints seconds by stage, and the visibility stage beside the same rays through bare Embree calls.
#include "apps/bench/stage_ratio.h"
#include "sim/parallel.h"

#include <fmt/format.h>

#include <cstdlib>

using namespace laterna;

namespace {

void print_ratios(const Scene& scene, int repeats) {
  for (const int width : {8, 16}) {
    for (const bool robust : {false, true}) {
      const BareWay way{width, true, robust};
      const VisibilityTimes t = visibility_over_embree(scene, way, repeats);
      fmt::print(
          "  {:24} bare {:5.1f} ms ({:5.1f} ns a ray); visibility {:5.1f} ms (surface {:5.1f}, light "
          "{:5.1f}); "
          "ratio {:.2f}\n",
          describe(way), 1e3 * t.bare, 1e9 * t.bare / t.rays, 1e3 * t.visibility, 1e3 * t.surface,
          1e3 * t.light, t.ratio);
    }
  }
}

void print_capture(const Scene& scene, const char* what, bool bilinear, double noise, int repeats) {
  const CaptureTimes t = time_capture(scene, bilinear, noise, repeats);
  const glm::ivec2 size = scene.cameras[0].device.intrinsics.size;
  fmt::print(
      "  {:24} build {:5.1f} ms, rays {:4.1f}, surface {:5.1f}, light {:5.1f}, replay of {} pictures {:6.1f} "
      "({:.2f} ns per pixel and picture)\n",
      what, 1e3 * t.build, 1e3 * t.rays, 1e3 * t.surface, 1e3 * t.light, t.pictures, 1e3 * t.replay,
      1e9 * t.replay / (double(size.x) * size.y * t.pictures));
}

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 15;
  const Scene scene = bench_scene(100000);
  Scene with_lens = scene;
  with_lens.cameras[0].device.lens = {"LENSMODEL_OPENCV4", {-0.05, 0.02, 0.001, -0.001}};
  with_lens.projectors[0].device.lens = {"LENSMODEL_OPENCV4", {-0.05, 0.02, 0.001, -0.001}};
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    fmt::print("{} thread{}, {} triangles, 1280x800\n", threads, threads > 1 ? "s" : "",
               scene.objects[0].mesh.triangles.size());
    print_ratios(scene, repeats);
    print_capture(scene, "nearest", false, 0, repeats);
    print_capture(scene, "bilinear", true, 0, repeats);
    print_capture(scene, "nearest, noise", false, 1.5, std::min(repeats, 3));
    print_capture(with_lens, "nearest, both lenses", false, 0, std::min(repeats, 3));
  }
}
