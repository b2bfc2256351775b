#include "apps/lab/classics/slide_projector.h"

#include "apps/lab/classics/core_picture.h"
#include "apps/lab/classics/panels.h"
#include "sim/scene_file.h"

#include <algorithm>

namespace laterna {

namespace {

double share_lit(const CoreView& view) {
  std::size_t lit = 0;
  for (std::size_t p = 0; p < view.lights[0].why.values.size(); ++p) lit += view.lights[0].lit(p);
  return double(lit) / double(view.lights[0].why.values.size());
}

}  // namespace

ClassicResult slide_projector(const std::filesystem::path& scenes) {
  const Scene scene = load_scene(scenes / "slide_projector.toml");
  const CoreView view(scene);
  const Image<float> picture = core_picture(view);
  const double white = std::ranges::max(picture.values);
  ClassicResult result;
  result.pictures.push_back({"slide_projector", grey_canvas(picture, white)});
  result.figures.push_back({"pixels with light", share_lit(view), "", 1e-3});
  return result;
}

}  // namespace laterna
