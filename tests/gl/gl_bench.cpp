// Milliseconds per pattern, ours and the rasteriser's: the same scene, pictures and run, shadows in both.
//
//   gl_bench [SCENE.toml [REPEATS [SHADOW_MAP_PX]]]
//
// Not run by ctest.
#include "apps/bench/timing.h"
#include "render/replay.h"
#include "render/trace_rows.h"
#include "sim/error.h"
#include "sim/parallel.h"
#include "sim/scene_file.h"
#include "tests/gl/context.h"
#include "tests/gl/rasteriser.h"
#include "tests/render/rig.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>

namespace laterna::gl {
namespace {

// Named medians over repeats, in the order of their first.
class Times {
 public:
  template <class Action>
  double measure(const std::string& name, double share, const Action& action) {
    const double s = seconds(action) * share;
    add(name, s);
    return s;
  }
  void add(const std::string& name, double s) {
    const auto at = std::ranges::find(rows_, name, &Row::name);
    (at == rows_.end() ? rows_.emplace_back(Row{name, {}}) : *at).seconds.push_back(s);
  }
  void print() const {
    for (const Row& row : rows_) fmt::print("{:<52}{:9.3f} ms\n", row.name, 1e3 * median(row.seconds));
  }

 private:
  struct Row {
    std::string name;
    std::vector<double> seconds;
  };
  std::vector<Row> rows_;
};

double ours(const Scene& scene, const BinaryPatternStack& patterns, const Exposure& exposure,
            CapturedStack& stack, Times& times) {
  const Camera& camera = scene.cameras[0];
  const double each = 1.0 / patterns.count;
  std::unique_ptr<RayScene> rays;
  const double build =
      times.measure("ours: tree of triangles, once", 1, [&] { rays = std::make_unique<RayScene>(scene); });
  SurfaceMap surface;
  LightMap light;
  const double trace = times.measure("ours: rays of camera and shadow, once", 1, [&] {
    surface = trace_surface(*rays, scene, camera);
    light = trace_light(*rays, scene, surface, scene.projectors[0]);
  });
  const ImageRows rows{{surface.width, surface.height},
                       [&](LightRows& region) { direct_rows(surface, light, {}, 0, region); }};
  const double replay = times.measure("ours: replay, per pattern", each,
                                      [&] { play_stack(rows, Lookup::nearest, patterns, exposure, stack); });
  const double whole = (build + trace) * each + replay;
  times.add("ours: all of it, per pattern", whole);
  return whole;
}

double theirs(Rasteriser& rasteriser, const Target& target, const std::vector<Image<std::uint8_t>>& slides,
              double saturation, Times& times) {
  const double each = 1.0 / double(slides.size());
  const double depth = times.measure("rasteriser: depth, once", 1, [&] {
    rasteriser.draw_depth(target);
    glFinish();
  });
  std::vector<GLuint> textures;
  const double sent = times.measure("rasteriser: slide to texture, per pattern", each, [&] {
    for (const auto& slide : slides) textures.push_back(upload(slide, Lookup::nearest));
    glFinish();
  });
  double drawn = 0, read = 0;
  for (const GLuint texture : textures) {
    drawn += each * seconds([&] {
               rasteriser.draw_light(texture, saturation);
               glFinish();
             });
    read += each * seconds([&] { read_u8(target, 0); });
  }
  glDeleteTextures(GLsizei(textures.size()), textures.data());
  times.add("rasteriser: light, per pattern", drawn);
  times.add("rasteriser: readback, per pattern", read);
  const double whole = depth * each + sent + drawn + read;
  times.add("rasteriser: all of it, per pattern", whole);
  return whole;
}

void run(const std::string& path, int repeats, int shadow_map_px) {
  const Context context;
  const Scene scene = load_scene(path);
  const GraySequence sequence{scene.projectors[0].device.intrinsics.size};
  const BinaryPatternStack patterns = make_binary_pattern_stack(sequence);
  std::vector<Image<std::uint8_t>> slides;
  for (int k = 0; k < patterns.count; ++k) slides.push_back(pattern_picture(sequence, k));
  const double saturation = laterna::testing::automatic_saturation(laterna::testing::Traced(scene));
  Rasteriser rasteriser(scene, {.shadow_map_px = shadow_map_px});
  const Target target = make_target(scene.cameras[0].device.intrinsics.size, {GL_R8});
  CapturedStack stack = ImageStack<std::uint8_t>(target.size.x, target.size.y, patterns.count);
  Times times, warming;
  ours(scene, patterns, {8, saturation, 0, {}}, stack, warming);
  theirs(rasteriser, target, slides, saturation, warming);
  std::vector<double> ratios;
  for (int i = 0; i < repeats; ++i) {
    const double a = ours(scene, patterns, {8, saturation, 0, {}}, stack, times);
    ratios.push_back(theirs(rasteriser, target, slides, saturation, times) / a);
  }
  fmt::print("{}, {} patterns, {} threads, shadow map of {}; {}\n", path, patterns.count, thread_count(),
             shadow_map_px, context.name());
  times.print();
  fmt::print("{:<52}{:9.1f}\n", "rasteriser over ours, per pattern", median(ratios));
}

}  // namespace
}  // namespace laterna::gl

int main(int count, char** words) {
  try {
    laterna::gl::run(count > 1 ? words[1] : "data/scenes/house.toml", count > 2 ? std::atoi(words[2]) : 5,
                     count > 3 ? std::atoi(words[3]) : 2048);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
