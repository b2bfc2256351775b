// Scene to pictures, kept in memory: what each camera sees, which projector pixel lights it, and the captured
// stacks.
#pragma once

#include "render/direct_light.h"
#include "render/image_rows.h"
#include "render/pixel_samples.h"
#include "render/ray_scene.h"
#include "render/surface.h"
#include "sim/image.h"
#include "sim/scene.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace laterna {

/// Seconds of wall clock by stage, in the order in which stages first ran.
struct StageTimes {
  struct Stage {
    std::string name;
    double seconds;
  };
  std::vector<Stage> stages;

  void add(const std::string& name, double seconds);
  double total() const;

  /// Runs `work` and adds its time to the stage.
  template <class Work>
  auto measure(const std::string& name, Work&& work);
};

/// A line of progress, for people.
using Progress = std::function<void(const std::string&)>;

/// One projector as one camera sees it.
struct View {
  int camera = 0, projector = 0;  ///< indices into the scene
  LightMap light;
  double saturation_cd_per_m2 = 0;
};

/// A scene ready for rays, and the rays of its cameras.
struct SceneRays {
  RayScene rays;
  std::vector<CameraRays> directions;  ///< one per camera
  std::unique_ptr<const Scene>
      displaced;  ///< the scene that the rays meet where displacement moves its meshes

  const Scene& as_seen(const Scene& given) const { return displaced ? *displaced : given; }
};

/// Throws InputError where the scene has no projector or no camera.
SceneRays make_rig(const Scene& scene, StageTimes& times);

/// What does not depend on the patterns: rays are traced once.
struct Traced : SceneRays {
  std::vector<SurfaceMap> surfaces;  ///< one per camera
  std::vector<PixelArray<glm::dvec3>>
      points_world;         ///< one per camera: what each pixel sees, m; NaN where nothing
  std::vector<View> views;  ///< camera by camera, projector by projector

  const View& view(int camera, int projector) const;
};

/// Traces every camera's surface and every projector's light on it, and exposes each view. Throws InputError
/// where the scene has no projector or no camera.
Traced trace(const Scene& scene, StageTimes& times, const Progress& progress = {});

/// The same without exposure, for who may throw the maps away.
Traced trace_maps(const Scene& scene, StageTimes& times, const Progress& progress = {});

/// Chooses each view's exposure: the sensor's own, or automatic. `traced` is of `scene`.
void expose_views(const Scene& scene, Traced& traced, StageTimes& times);

/// What a row of tiles of a camera's image sees, and one projector's light on it, at pixel centres.
struct Strip {
  SurfaceMap surface;
  LightMap light;
};

/// Traces one view strip by strip, so that no map of the image is held. What it is made from must outlive it.
class StripTracer {
 public:
  StripTracer(const Scene& scene, const SceneRays& rig, int camera, int projector);
  int count() const;  ///< of rows of tiles
  Strip trace(int tile_row) const;

 private:
  const Scene& scene_;
  const SceneRays& rig_;
  int camera_, projector_;
  CameraView eye_;
  ProjectorView source_;
};

/// The rows of one view, with every effect of the scene, traced at each call: no map of the image is held.
ImageRows rig_rows(const Scene& scene, const SceneRays& rig, int camera, int projector,
                   const PixelSamples& samples);

/// The luminance that fills the scale: the sensor's own, or automatic, from the light at pixel centres (at
/// every sixteenth tile of them with inter-reflection).
double saturation_cd_per_m2(const Scene& scene, const SceneRays& rig, int camera, int projector,
                            StageTimes& times);

/// The rows of one view, with every effect of the scene: from the maps where a pixel's row is the direct
/// light at its centre, else traced anew at each call. `scene` and `traced` must outlive the result. `seed`
/// places samples.
ImageRows view_rows(const Scene& scene, const Traced& traced, const View& view, std::uint64_t seed);

/// The pictures of one view: the projector's sequence with the other projectors at black.
CapturedStack capture_view(const Scene& scene, const Traced& traced, const View& view, std::uint64_t seed,
                           StageTimes& times);

/// Pictures of rows at hand, those of white light, with colour, camera glare and timing; where timing moves
/// the rig, its moved rows are traced here. `seed` draws the noise; the entries that played are added to
/// `entries`.
CapturedStack capture_rows(const Scene& scene, int camera, int projector, const ImageRows& rows,
                           double saturation_cd_per_m2, std::uint64_t seed, StageTimes& times,
                           std::atomic<std::uint64_t>* entries = nullptr);

/// Share of something, in per cent, for people.
struct Overlap {
  double camera_lit = 0;      ///< lit pixels over pixels that see a surface
  double projector_seen = 0;  ///< projector pixels (in cells of 8×8) that some lit camera pixel sees
};
Overlap overlap(const Scene& scene, const Traced& traced, const View& view);

}  // namespace laterna

#include <chrono>
#include <type_traits>

template <class Work>
auto laterna::StageTimes::measure(const std::string& name, Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  const auto stop = [&] {
    add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  };
  if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
    work();
    stop();
  } else {
    auto result = work();
    stop();
    return result;
  }
}
