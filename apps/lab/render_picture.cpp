#include "apps/lab/render_picture.h"

#include "render/bake.h"
#include "render/effects/camera_show.h"
#include "render/effects/scaler.h"
#include "render/replay.h"
#include "render/trace_rows.h"
#include "render/transpose.h"
#include "sim/error.h"
#include "sim/formats/exr_camera.h"
#include "sim/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace laterna {

namespace {

constexpr int dual_samples = 16;

// The first of the nouns that bears the name; the first of all where no name is given.
template <class Nouns, class NameOf>
int find_named(const Nouns& nouns, const std::string& name, const char* option, const NameOf& name_of) {
  std::string known;
  for (int i = 0; i < int(nouns.size()); ++i) {
    if (name.empty() || name_of(nouns[i]) == name) return i;
    known += " \"" + name_of(nouns[i]) + "\"";
  }
  throw InputError(fmt::format("{}: found \"{}\", expected one of{}", option, name, known));
}

// What the words name, ready for rays.
struct Selected {
  const Scene& scene;
  const SceneRays rig;
  int camera, projector;

  Selected(const Scene& s, const RenderOptions& options, StageTimes& times)
      : scene(s),
        rig(make_rig(s, times)),
        camera(find_named(s.cameras, options.camera, "--camera", [](auto& c) { return c.device.name; })),
        projector(find_named(s.projectors, options.projector, "--projector",
                             [](auto& p) { return p.device.name; })) {}
  const Projector& source() const { return scene.projectors[projector]; }
  ImageRows rows(const RenderOptions& options) const {
    PixelSamples samples = samples_of(scene, camera, options.seed);
    if (options.samples_per_pixel > 0) samples.count = options.samples_per_pixel;
    if (options.kind == RenderKind::dual) {
      samples.count = std::max(samples.count, dual_samples);
      if (samples.side_px == 0) samples.side_px = 1;
    }
    return rig_rows(scene, rig, camera, projector, samples);
  }
};

Image<float> picture_or_white(const std::filesystem::path& file, const glm::ivec2& size, const char* whose) {
  if (file.empty()) return {size.x, size.y, 1.0f};
  Image<float> picture = read_grey_float(file, Encoding::linear);
  if (picture.width != size.x || picture.height != size.y)
    throw InputError(fmt::format("{}: {}x{} pixels, expected the {}'s {}x{}", file.string(), picture.width,
                                 picture.height, whose, size.x, size.y));
  return picture;
}

// The scene with one picture in place of its patterns. A single picture has no neighbours in time.
Scene showing(const Selected& selected, const std::filesystem::path& file) {
  Scene playing = selected.scene;
  const glm::ivec2 size = input_size(playing.effects, selected.source());
  playing.slide = std::make_shared<const Slide>(Slide{picture_or_white(file, size, "projector"), true, {}});
  playing.pictures = nullptr;
  playing.patterns.kind = PatternKind::slide;
  playing.effects.slide = true;
  playing.effects.timing = false;
  return playing;
}

Image<float> photograph_cd_per_m2(const Selected& selected, const RenderOptions& options,
                                  const std::filesystem::path& show) {
  const Scene playing = showing(selected, show);
  const CameraShow played =
      make_camera_show(playing, selected.camera, selected.projector, selected.rows(options));
  const auto stack = play_luminance(played.rows, selected.source().lookup, played.show());
  Image<float> picture(stack.width, stack.height);
  std::copy(stack.values.begin(), stack.values.end(), picture.values.begin());
  return picture;
}

// As the camera's sensor delivers it.
void write_photograph(const Selected& selected, const RenderOptions& options,
                      const std::filesystem::path& target, StageTimes& times) {
  const double saturation =
      saturation_cd_per_m2(selected.scene, selected.rig, selected.camera, selected.projector, times);
  const CapturedStack stack =
      capture_rows(showing(selected, options.show), selected.camera, selected.projector,
                   selected.rows(options), saturation, options.seed, times);
  std::visit(
      [&](const auto& pictures) {
        using Value = typename std::decay_t<decltype(pictures)>::value_type;
        const PixelType type = sizeof(Value) == 1 ? PixelType::u8 : PixelType::u16;
        write_picture(target, {pictures.values.data(), pictures.width, pictures.height, 1, type, {"Y"}});
      },
      stack);
}

Image<float> dual_cd_per_m2(const Selected& selected, const RenderOptions& options) {
  const glm::ivec2 camera_size = selected.scene.cameras[selected.camera].device.intrinsics.size;
  const Image<float> light = picture_or_white(options.show, camera_size, "camera");
  const Image<double> sum = apply_transpose(selected.rows(options), selected.source().lookup, light,
                                            selected.source().device.intrinsics.size);
  Image<float> picture(sum.width, sum.height);
  std::copy(sum.values.begin(), sum.values.end(), picture.values.begin());
  return picture;
}

BakedTexture bake(const Selected& selected, const RenderOptions& options) {
  const Scene& scene = selected.rig.as_seen(selected.scene);
  int mesh = 0;
  while (options.mesh.empty() && mesh + 1 < int(scene.objects.size()) &&
         scene.objects[mesh].mesh.texture_coordinates.empty())
    ++mesh;
  if (!options.mesh.empty())
    mesh = find_named(scene.objects, options.mesh, "--mesh", [](const Object& o) { return o.name; });
  const Camera& camera = scene.cameras[selected.camera];
  const Image<float> photograph =
      options.show.empty() ? photograph_cd_per_m2(selected, options, {})
                           : picture_or_white(options.show, camera.device.intrinsics.size, "camera");
  return bake_photograph(selected.rig.rays, scene, std::uint32_t(mesh), camera, photograph,
                         options.texture_px);
}

// For the eye: 8 bits.
Image<std::uint8_t> exposed(const Image<float>& picture) {
  std::vector<float> lit;
  std::copy_if(picture.values.begin(), picture.values.end(), std::back_inserter(lit),
               [](float value) { return value > 0; });
  Image<std::uint8_t> out(picture.width, picture.height);
  if (lit.empty()) return out;
  const auto at = lit.begin() + std::ptrdiff_t(0.999 * double(lit.size() - 1));
  std::nth_element(lit.begin(), at, lit.end());
  const float scale = 0.8f * 255 / *at;
  for (std::size_t i = 0; i < out.values.size(); ++i)
    out.values[i] = std::uint8_t(std::lround(std::clamp(picture.values[i] * scale, 0.0f, 255.0f)));
  return out;
}

Image<float> as_float(const Image<std::uint8_t>& mask) {
  Image<float> picture(mask.width, mask.height);
  std::copy(mask.values.begin(), mask.values.end(), picture.values.begin());
  return picture;
}

}  // namespace

RenderKind render_kind_of(const std::string& word) {
  if (word == "photo") return RenderKind::photo;
  if (word == "dual") return RenderKind::dual;
  if (word == "bake") return RenderKind::bake;
  throw InputError(fmt::format("--as: found \"{}\", expected photo, dual or bake", word));
}

void render_picture(const Scene& scene, const RenderOptions& options, const std::filesystem::path& target,
                    StageTimes& times) {
  const Selected selected(scene, options, times);
  const bool numbers = target.extension() == ".exr";
  const auto write = [&](const Image<float>& picture, const Device& by) {
    if (numbers) return write_exr_layers(target, {{"Y"}, {picture}, picture_camera(by)});
    write_picture(target, exposed(picture));
  };
  switch (options.kind) {
    case RenderKind::photo:
      if (!numbers) return write_photograph(selected, options, target, times);
      return write(photograph_cd_per_m2(selected, options, options.show),
                   scene.cameras[selected.camera].device);
    case RenderKind::dual:
      return write(times.measure("transpose", [&] { return dual_cd_per_m2(selected, options); }),
                   selected.source().device);
    case RenderKind::bake: {
      const BakedTexture texture = times.measure("bake", [&] { return bake(selected, options); });
      if (!numbers) return write_picture(target, exposed(texture.value));
      return write_exr_layers(target, {{"Y", "covered"}, {texture.value, as_float(texture.covered)}});
    }
  }
}

}  // namespace laterna
