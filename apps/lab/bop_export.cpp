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

// A mesh as a model, and where that stands.
struct PlacedModel {
  BopModel model;
  Rigid world_from_model{};
};

PlacedModel placed_model(const Object& object, int obj_id, Notes& notes) {
  const glm::dmat4& m = object.world_from_object;
  if (is_rigid(m)) return {{obj_id, object.mesh}, {glm::dmat3(m), glm::dvec3(m[3])}};
  notes.push_back(fmt::format(
      "mesh \"{}\" is scaled: its model's frame is the world's, in the size it has there", object.name));
  PlacedModel placed{{obj_id, object.mesh}};
  for (glm::dvec3& x : placed.model.mesh.positions) x = glm::dvec3(m * glm::dvec4(x, 1));
  if (glm::determinant(glm::dmat3(m)) < 0)  // a mirror turns the fronts round
    for (glm::uvec3& t : placed.model.mesh.triangles) std::swap(t.y, t.z);
  return placed;
}

// The camera whose picture is the one `places` pictures to the right and down of its own.
Camera beside(Camera camera, glm::ivec2 places) {
  Intrinsics& k = camera.device.intrinsics;
  const glm::dvec2 first_px = places * k.size;
  k.cx -= first_px.x, k.cy -= first_px.y;
  return camera;
}

// What a camera would see of one mesh alone.
struct Silhouette {
  Image<std::uint8_t> inside;
  BopExtent whole;
};

Silhouette silhouette(const SceneRays& alone, const Scene& scene, const Camera& camera) {
  Silhouette s;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const glm::ivec2 places(x, y);
      const SurfaceMap surface = trace_surface(alone.rays, alone.as_seen(scene), beside(camera, places));
      const Image<std::uint8_t> mask = mask_of(surface, [&](std::size_t i) { return surface.hit(i); });
      s.whole = merged(s.whole, extent_of(mask, places * camera.device.intrinsics.size));
      if (places == glm::ivec2(0, 0)) s.inside = mask;
    }
  return s;
}

void check_pinholes(const Scene& scene) {
  for (const Camera& camera : scene.cameras)
    if (!is_pinhole(camera.device.lens))
      throw InputError(
          fmt::format("BOP holds no lens, \"{}\" has {}", camera.device.name, camera.device.lens.model));
}

}  // namespace

BopScene bop_scene(const fs::path& capture, Notes& notes) {
  const CaptureManifest manifest = read_manifest(capture);
  if (manifest.scene.empty())
    throw InputError(capture.string() + ": the capture has no scene, expected a simulated one for its depth");
  const Scene scene = load_scene(capture / manifest.scene);
  check_pinholes(scene);
  StageTimes times;
  const SceneRays rig = make_rig(scene, times);
  BopScene result;
  std::vector<SurfaceMap> surfaces;
  for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
    const Device& camera = scene.cameras[c].device;
    surfaces.push_back(trace_surface(rig.rays, rig.as_seen(scene), scene.cameras[c], rig.directions[c]));
    result.pictures.push_back({camera, depth_of(surfaces[c]), gray_of(capture, manifest, camera.name), {}});
  }
  for (std::size_t k = 0; k < scene.objects.size(); ++k) {
    Scene alone = scene;
    alone.objects = {scene.objects[k]};
    const SceneRays rays = make_rig(alone, times);
    PlacedModel placed = placed_model(rays.as_seen(alone).objects[0], int(k) + 1, notes);
    for (std::size_t c = 0; c < scene.cameras.size(); ++c) {
      Silhouette s = silhouette(rays, alone, scene.cameras[c]);
      result.pictures[c].objects.push_back(
          {int(k) + 1, compose(scene.cameras[c].device.device_from_world, placed.world_from_model),
           std::move(s.inside),
           mask_of(surfaces[c], [&](std::size_t i) { return surfaces[c].object.values[i] == k; }), s.whole});
    }
    result.models.push_back(std::move(placed.model));
  }
  return result;
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
