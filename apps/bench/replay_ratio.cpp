#include "apps/bench/replay_ratio.h"

#include "apps/bench/timing.h"
#include "apps/lab/trial.h"
#include "render/automatic_exposure.h"
#include "render/noise.h"
#include "render/replay.h"
#include "render/trace_rows.h"
#include "sim/parallel.h"

#include <cstring>
#include <random>

namespace laterna {

namespace {

// One value for each byte of a stack, in as many pieces as replay's regions; each repeat writes another.
double fill_seconds(CapturedStack& stack) {
  auto& values = std::get<ImageStack<std::uint8_t>>(stack).values;
  constexpr std::size_t piece = std::size_t{1} << 18;
  static int value = 0;
  ++value;
  return seconds([&] {
    parallel_for((values.size() + piece - 1) / piece, [&](std::size_t i) {
      std::memset(values.data() + i * piece, value, std::min(piece, values.size() - i * piece));
    });
  });
}

// The rows of some regions around the image's middle, as the tracer leaves them in the cache, played over and
// over until the image is full.
struct WarmRows {
  std::vector<LightRows> rows;
  ImageRows image;

  explicit WarmRows(const ImageRows& source) : image(source) {
    constexpr int kept = 4;
    const glm::ivec2 step = source.region_px, middle = source.size / 2 / step * step;
    for (int i = 0; i < kept; ++i) {
      rows.emplace_back().region = {middle.x, middle.y + i * step.y, step.x, step.y};
      source.rows(rows.back());
    }
  }
  // Each thread's cache holds its own, as it holds what it has just traced.
  std::vector<LightRows>& rows_of_this_thread() const {
    thread_local const WarmRows* owner = nullptr;
    thread_local std::vector<LightRows> own;
    if (owner != this) own = rows;
    owner = this;
    return own;
  }
  void play(Lookup lookup, const AnyPatterns& patterns, const Exposure& exposure, CapturedStack& out) const {
    const glm::ivec2 count = image.size / image.region_px;
    parallel_for(count.y, [&](std::size_t y) {
      std::vector<LightRows>& own = rows_of_this_thread();
      for (int x = 0; x < count.x; ++x) {
        LightRows& r = own[x % own.size()];
        r.region.x = x * image.region_px.x, r.region.y = int(y) * image.region_px.y;
        play_rows(r, lookup, patterns, exposure, out);
      }
    });
  }
};

struct Prepared {
  RayScene rays;
  CameraRays directions;
  SurfaceMap surface;
  LightMap light;
  Exposure exposure;

  explicit Prepared(const Scene& scene)
      : rays(scene),
        directions(scene.cameras[0].device),
        surface(trace_surface(rays, scene, scene.cameras[0], directions)),
        light(trace_light(rays, scene, surface, scene.projectors[0])),
        exposure(make_exposure({}, automatic_saturation(scene), {})) {}
  double automatic_saturation(const Scene& scene) const {
    const ImageRows direct = image(scene, 1);
    return automatic_saturation_cd_per_m2({&direct, 1});
  }
  ImageRows image(const Scene& scene, int samples) const {
    return {scene.cameras[0].device.intrinsics.size, trace_rows(rays, scene, 0, directions, 0, {samples, 1})};
  }
};

// Both fill the same small array over and over.
double std_normal_over_noise(std::uint32_t samples) {
  std::mt19937_64 engine(1);
  std::normal_distribution<float> normal;
  float deviates[noise_values];
  volatile float sink = 0;
  const auto fill_all = [&](const auto& fill) {
    return seconds([&] {
      for (std::uint32_t i = 0; i < samples / noise_values; ++i) {
        fill(i);
        sink = deviates[i % noise_values];
      }
    });
  };
  const double standard = fill_all([&](std::uint32_t) {
    for (float& deviate : deviates) deviate = normal(engine);
  });
  const double own = fill_all([&](std::uint32_t i) {
    normal_deviates({1, 0, 0}, NoiseStream::temporal, i * noise_pixels, 0, deviates);
  });
  static_cast<void>(sink);
  return standard / own;
}

}  // namespace

ReplayTimes time_replay(const Scene& scene, int repeats) {
  const GraySequence sequence{scene.projectors[0].device.intrinsics.size};
  const PatternStack values = make_pattern_stack(sequence);
  const BinaryPatternStack bits = make_binary_pattern_stack(sequence);
  const Prepared prepared(scene);
  const WarmRows warm(prepared.image(scene, 1));
  Exposure noisy = prepared.exposure;
  noisy.noise_sigma_dn = 1.5;
  CapturedStack stack = play_stack(warm.image, Lookup::nearest, bits, prepared.exposure);
  const auto play = [&](Lookup lookup, const AnyPatterns& patterns, const Exposure& exposure) {
    return seconds([&] { warm.play(lookup, patterns, exposure, stack); });
  };
  std::vector<double> fill, binary, bilinear, noise, binary_ratio, bilinear_ratio, noise_ratio, normal_ratio;
  for (int i = -1; i < repeats; ++i) {  // the first round warms up
    const double f = fill_seconds(stack), b = play(Lookup::nearest, bits, prepared.exposure);
    const double v = play(Lookup::bilinear, values, prepared.exposure),
                 n = play(Lookup::bilinear, values, noisy);
    const double r = std_normal_over_noise(1u << 20);
    if (i < 0) continue;
    fill.push_back(f), binary.push_back(b), bilinear.push_back(v), noise.push_back(n);
    binary_ratio.push_back(b / f), bilinear_ratio.push_back(v / f), noise_ratio.push_back((n - v) / v);
    normal_ratio.push_back(r);
  }
  return {median(fill),         median(binary),         median(bilinear),    median(noise),
          median(binary_ratio), median(bilinear_ratio), median(noise_ratio), median(normal_ratio)};
}

StackTimes time_stack(const Scene& scene, int repeats) {
  const Camera& camera = scene.cameras[0];
  const BinaryPatternStack bits = make_binary_pattern_stack({scene.projectors[0].device.intrinsics.size});
  const Exposure exposure = Prepared(scene).exposure;
  std::vector<double> one, sixteen, ratio;
  for (int i = -1; i < repeats; ++i) {
    double build = 0, played[2];
    for (const int samples : {1, 16}) {
      std::unique_ptr<RayScene> rays;
      build = seconds([&] { rays = std::make_unique<RayScene>(scene); });
      played[samples == 16] = seconds([&] {
        const CameraRays directions(camera.device);
        const ImageRows image{camera.device.intrinsics.size,
                              trace_rows(*rays, scene, 0, directions, 0, {samples, 1})};
        const CapturedStack stack = play_stack(image, Lookup::nearest, bits, exposure);
      });
      if (i >= 0) (samples == 16 ? sixteen : one).push_back(build + played[samples == 16]);
    }
    if (i >= 0) ratio.push_back(played[1] / played[0]);
  }
  return {median(one), median(sixteen), median(ratio)};
}

double time_roundtrip(const Scene& source, int repeats) {
  Scene scene = source;
  scene.cameras[0].sensor.noise_sigma_dn = 1.5;
  std::vector<double> times;
  for (int i = -1; i < repeats; ++i) {
    const double s = seconds([&] {
      StageTimes stages;
      const Traced traced = trace(scene, stages);
      run_trial(scene, traced, {}, stages);
    });
    if (i >= 0) times.push_back(s);
  }
  return median(times);
}

}  // namespace laterna
