#include "sim/scene_build.h"

#include "sim/believed.h"
#include "sim/device_spec.h"
#include "sim/map_files.h"
#include "sim/object_build.h"
#include "sim/scene_heading.h"

#include <algorithm>

namespace laterna {

namespace {

/// Whether each projector can show the sequence; behind a scaler, another size is asked for when it does.
void check_patterns(const Scene& scene) {
  if (scene.effects.scaler) return;
  for (const Projector& projector : scene.projectors)
    about(heading("projector", projector.device.name), [&] {
      validate(PatternSequence{scene.patterns, projector.device.intrinsics.size});
    });
}

template <class Spec>
int index_of(const std::vector<Spec>& devices, const std::string& name) {
  return int(
      std::find_if(devices.begin(), devices.end(), [&](const Spec& d) { return d.device.name == name; }) -
      devices.begin());
}

ColourMixing build_mixing(const ColourSpec& spec, const SceneSpec& named) {
  ColourMixing mixing{index_of(named.projectors, spec.projector), index_of(named.cameras, spec.camera), {}};
  for (int i = 0; i < 9; ++i) mixing.channels[i / 3][i % 3] = spec.mixing[i];
  return mixing;
}

void switch_off_lenses(Scene& scene) {
  if (!scene.effects.projector_lens)
    for (Projector& projector : scene.projectors) projector.device.lens = {};
  if (!scene.effects.camera_lens)
    for (Camera& camera : scene.cameras) camera.device.lens = {};
}

}  // namespace

Scene build_scene(const SceneSpec& spec, const std::filesystem::path& folder) {
  check(spec);
  Scene scene{.objects = {},
              .projectors = {},
              .cameras = {},
              .ambient_lx = spec.ambient_lx,
              .patterns = spec.patterns.parameters,
              .effects = spec.effects,
              .inter_reflection = spec.inter_reflection,
              .slide = {},
              .pictures = {},
              .pattern_colour = spec.patterns.colour,
              .mixings = {},
              .timing = spec.timing,
              .believe_truth = spec.believe_truth};
  const SceneSpec named = with_names(spec);
  AlbedoMaps maps;
  for (const MeshSpec& mesh : named.meshes) {
    check(mesh);
    scene.objects.push_back(
        about(heading("mesh", mesh.name), [&] { return build_object(mesh, folder, maps); }));
  }
  for (const ProjectorSpec& p : named.projectors) {
    const std::string what = heading("projector", p.device.name);
    check(p);
    scene.projectors.push_back({device_of(p.device, folder, what), p.flux_lm, p.lookup, p.border, p.effects,
                                about(what, [&] { return vignetting_map(p.effects.vignetting, folder); })});
  }
  for (const CameraSpec& c : named.cameras) {
    const std::string what = heading("camera", c.device.name);
    check(c);
    scene.cameras.push_back({device_of(c.device, folder, what), c.sensor, c.vignetting,
                             about(what, [&] { return vignetting_map(c.vignetting, folder); }),
                             c.samples_per_pixel, c.optics, c.colour_filter, c.veiling_glare, c.believed});
    about(what + ": believed", [&] { believed_device(scene.cameras.back()); });
  }
  switch_off_lenses(scene);
  if (spec.effects.slide)
    scene.slide = std::make_shared<const Slide>(read_slide(spec.patterns, folder / spec.patterns.file));
  if (spec.patterns.parameters.kind == PatternKind::pictures)
    scene.pictures = std::make_shared<const std::vector<Slide>>(read_slides(spec.patterns, folder));
  check_patterns(scene);
  for (const ColourSpec& c : named.colours) scene.mixings.push_back(build_mixing(c, named));
  return scene;
}

}  // namespace laterna
