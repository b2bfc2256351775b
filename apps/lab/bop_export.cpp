#include "apps/lab/bop_export.h"

#include "apps/lab/simulation.h"
#include "sim/capture_folder.h"
#include "sim/error.h"
#include "sim/formats/exr_camera.h"
#include "sim/plain_name.h"
#include "sim/safe_write.h"
#include "sim/scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

namespace fs = std::filesystem;

Image<float> depth_of(const SurfaceMap& surface) {
  Image<float> depth_m(surface.width, surface.height);
  std::copy(surface.depth_m.values.begin(), surface.depth_m.values.end(), depth_m.values.begin());
  return depth_m;
}

template <class Inside>
Image<std::uint8_t> mask_of(const SurfaceMap& surface, Inside&& inside) {
  Image<std::uint8_t> mask(surface.width, surface.height);
  for (std::size_t i = 0; i < mask.values.size(); ++i) mask.values[i] = inside(i) ? 255 : 0;
  return mask;
}

// Each pixel's brightest value over a sequence, in 8 bits.
Image<std::uint8_t> brightest(const CapturedStack& stack, int bit_depth) {
  return std::visit(
      [&](const auto& pictures) {
        Image<std::uint8_t> picture(pictures.width, pictures.height);
        for (int k = 0; k < pictures.count; ++k) {
          const auto values = pictures.picture(k);
          for (std::size_t i = 0; i < picture.values.size(); ++i)
            picture.values[i] =
                std::max(picture.values[i], std::uint8_t(values[i] >> std::max(0, bit_depth - 8)));
        }
        return picture;
      },
      stack);
}

Image<std::uint8_t> gray_of(const fs::path& capture, const CaptureManifest& manifest,
                            const std::string& camera) {
  for (const CaptureSequence& s : manifest.sequences)
    if (s.camera == camera) return brightest(read_pictures(capture, s), s.bit_depth);
  return {};
}

bool is_rigid(const glm::dmat4& m) {
  const glm::dmat3 r(m), off = r * glm::transpose(r) - glm::dmat3(1.0);
  double largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, glm::length(off[c]));
  return largest < 1e-9 && glm::determinant(r) > 0;
}

Rigid world_from_model(const Object& object, Notes& notes) {
  const glm::dmat4& m = object.world_from_object;
  if (is_rigid(m)) return {glm::dmat3(m), glm::dvec3(m[3])};
  notes.push_back(fmt::format(
      "mesh \"{}\" is scaled: its model's frame is the world's, in the size it has there", object.name));
  return {};
}

// What each camera would see of one mesh alone.
std::vector<Image<std::uint8_t>> silhouettes(const Scene& scene, const Object& object, StageTimes& times) {
  Scene alone = scene;
  alone.objects = {object};
  const SceneRays rig = make_rig(alone, times);
  std::vector<Image<std::uint8_t>> masks;
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    const SurfaceMap surface =
        trace_surface(rig.rays, rig.as_seen(alone), scene.cameras[c], rig.directions[c]);
    masks.push_back(mask_of(surface, [&](std::size_t i) { return surface.hit(i); }));
  }
  return masks;
}

}  // namespace

std::vector<BopPicture> bop_pictures(const fs::path& capture, Notes& notes) {
  const CaptureManifest manifest = read_manifest(capture);
  if (manifest.scene.empty())
    throw InputError(capture.string() + ": the capture has no scene, expected a simulated one for its depth");
  const Scene scene = load_scene(capture / manifest.scene);
  StageTimes times;
  const SceneRays rig = make_rig(scene, times);
  std::vector<BopPicture> pictures;
  std::vector<SurfaceMap> surfaces;
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    const Device& camera = scene.cameras[c].device;
    surfaces.push_back(trace_surface(rig.rays, rig.as_seen(scene), scene.cameras[c], rig.directions[c]));
    pictures.push_back({camera, depth_of(surfaces[c]), gray_of(capture, manifest, camera.name), {}});
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    const std::vector<Image<std::uint8_t>> whole = silhouettes(scene, scene.objects[k], times);
    const Rigid model = world_from_model(scene.objects[k], notes);
    for (std::size_t c = 0; c < pictures.size(); ++c)
      pictures[c].objects.push_back(
          {int(k) + 1, compose(pictures[c].camera.device_from_world, model), whole[c],
           mask_of(surfaces[c], [&](std::size_t i) { return surfaces[c].object.values[i] == k; })});
  }
  return pictures;
}

void write_bop_layers(const fs::path& to, const std::vector<BopPicture>& pictures) {
  PendingFolder folder(to);
  for (const BopPicture& picture : pictures) {
    const std::string& name = picture.camera.name;
    check_plain_name(name, to.string());
    if (picture.depth_m.values.empty())
      throw InputError(fmt::format("picture \"{}\" has no depth, expected one to write as layers", name));
    Image<float> id(picture.depth_m.width, picture.depth_m.height, -1);
    for (const BopObject& object : picture.objects)
      for (std::size_t i = 0; i < object.visible.values.size(); ++i)
        if (object.visible.values[i] != 0) id.values[i] = float(object.obj_id - 1);
    write_exr_layers(folder.path() / (name + ".exr"),
                     {{"depth.m", "object.id"}, {picture.depth_m, id}, picture_camera(picture.camera)});
  }
  folder.commit();
}

}  // namespace laterna
