#include "sim/instruction_sets.h"

#include "render/exposure_kernels.h"
#include "render/noise.h"
#include "render/replay_kernels.h"
#include "render/tile_kernels.h"
#include "tests/render/rig.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

namespace laterna {
namespace {

// Everything that the kernels compute from one set of random inputs, as bits.
using Bits = std::vector<std::uint32_t>;

template <class Values>
void append(Bits& bits, const Values& values) {
  for (const auto& v : values) {
    if constexpr (sizeof(v) == sizeof(std::uint64_t)) {
      const auto b = std::bit_cast<std::uint64_t>(v);
      bits.push_back(std::uint32_t(b)), bits.push_back(std::uint32_t(b >> 32));
    } else if constexpr (sizeof(v) == sizeof(std::uint32_t)) {
      bits.push_back(std::bit_cast<std::uint32_t>(v));
    } else {
      bits.push_back(std::uint32_t(v));
    }
  }
}

Bits noise_bits() {
  Bits bits;
  for (std::uint32_t group = 0; group < 40; ++group) {
    std::array<float, noise_values> deviates{};
    std::array<std::uint32_t, noise_values> words{};
    std::array<float, noise_pixels> means{}, counts{};
    normal_deviates({7, 1, 2}, NoiseStream::temporal, 64 * group, group, deviates.data());
    random_words({7, 1, 2}, NoiseStream::shot, 64 * group, group, words.data());
    for (int i = 0; i < noise_pixels; ++i) means[i] = 0.5f * float(i) - 0.3f;
    poisson_counts(means.data(), words.data(), counts.data());
    append(bits, deviates), append(bits, words), append(bits, counts);
  }
  return bits;
}

Bits exposure_bits() {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<float> any(-2, 2);
  Bits bits;
  ElectronModel model;
  model.dark_e = 3, model.full_well_e = 200, model.dark_noise_e = 2.2f, model.gain_dn_per_e = 0.7f;
  for (int k = 0; k < 20; ++k) {
    PixelGains gains{};
    std::array<float, noise_pixels> levels{}, deviates{}, means{}, signal{};
    for (int i = 0; i < noise_pixels; ++i) {
      gains.response[i] = 1 + 0.01f * any(random), gains.offset_dn[i] = any(random);
      levels[i] = 100 * (1 + any(random)), deviates[i] = any(random);
    }
    const LightKinds kinds =
        expose_medium(model, gains, levels.data(), deviates.data(), means.data(), signal.data());
    append(bits, means), append(bits, signal), append(bits, std::array{int(kinds.dim), int(kinds.bright)});
    expose_dim(model, gains, means.data(), levels.data(), deviates.data(), signal.data());
    append(bits, signal);
    expose_bright(model, gains, means.data(), deviates.data(), deviates.data(), signal.data());
    append(bits, signal);
    std::array<std::uint8_t, noise_pixels> dn8{};
    std::array<std::uint16_t, noise_pixels> dn16{};
    quantise(signal.data(), 255, noise_pixels, dn8.data()),
        quantise(signal.data(), 4095, noise_pixels, dn16.data());
    append(bits, dn8), append(bits, dn16);
  }
  return bits;
}

template <class Tap>
void append_sums(Bits& bits, const std::vector<Tap>& taps, int count) {
  std::array<std::uint32_t, block_pixels + 1> first{};
  for (int i = 0; i <= block_pixels; ++i) first[i] = std::uint32_t(taps.size() * i / block_pixels);
  std::array<float, block_pixels> base{};
  base.fill(0.25f);
  std::vector<float> scratch(std::size_t(padded(count)) * block_pixels, 0), levels(scratch.size(), 0);
  sum_taps(taps.data(), first.data(), base.data(), block_pixels, count, scratch.data(), levels.data());
  levels.resize(std::size_t(count) * block_pixels);
  append(bits, levels);
}

Bits replay_bits() {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<float> share(0, 1);
  std::vector<std::uint8_t> texels(5000);
  for (auto& t : texels) t = std::uint8_t(random());
  std::vector<float> light(256), added(64);
  for (auto& l : light) l = share(random);
  for (auto& a : added) a = share(random);
  const auto texel = [&] { return texels.data() + random() % 4900; };
  Bits bits;
  for (const int count : {1, 3, 5, 15, 16, 17, 44, 63}) {
    std::vector<BilinearTap> bilinear;
    std::vector<NearestTap> nearest;
    std::vector<TableTap> table;
    std::vector<BitTap> bit;
    for (int i = 0; i < 150; ++i) {
      bilinear.push_back({texel(), texel(), texel(), texel(), share(random), share(random), share(random)});
      nearest.push_back({texel(), share(random)});
      table.push_back({texel(), light.data(), added.data(), share(random)});
      bit.push_back({random(), share(random)});
    }
    append_sums(bits, bilinear, count), append_sums(bits, nearest, count);
    append_sums(bits, table, count), append_sums(bits, bit, count);
    std::array<std::uint64_t, block_pixels> codes{};
    std::array<std::uint8_t, block_pixels> off{}, on{};
    for (int i = 0; i < block_pixels; ++i)
      codes[i] = random(), off[i] = std::uint8_t(random()), on[i] = std::uint8_t(random());
    std::vector<std::uint8_t> out(std::size_t(count) * block_pixels);
    expand_bits(codes.data(), off.data(), on.data(), block_pixels, count, {out.data(), block_pixels});
    append(bits, out);
    std::array<double, 4 * block_pixels> entries{};
    std::array<float, block_pixels> white{};
    std::vector<std::uint64_t> columns(30), rows(20);
    for (auto& e : entries) e = 35 * share(random) - 2;
    for (auto& c : columns) c = random();
    for (auto& r : rows) r = random();
    nearest_codes({entries.data(), 0.3}, {30, 20, columns.data(), rows.data()}, codes.data(), white.data());
    append(bits, codes), append(bits, white);
  }
  return bits;
}

Bits tile_bits() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  const auto fill = [&](TileDoubles& values, double middle) {
    for (double& v : values) v = middle + any(random);
  };
  Bits bits;
  for (int k = 0; k < 50; ++k) {
    glm::dmat3 m;
    for (int i = 0; i < 9; ++i) m[i / 3][i % 3] = any(random);
    TileRays directions;
    TilePlanes planes;
    TileSurface surface;
    TilePoints points;
    TilePixels pixels;
    TileLight light;
    RayPacket rays = make_ray_packet();
    fill(directions.x, 0), fill(directions.y, 0);
    fill(directions.start_x_m, 0), fill(directions.start_y_m, 0);
    directions.from_lens = k % 3 == 0;
    fill(planes.normal_x, 0), fill(planes.normal_y, 0), fill(planes.normal_z, 0), fill(planes.distance, 2);
    alignas(64) TileFloats depth;
    for (float& t : depth) t = float(2 + any(random));
    aim_tile(m, directions, rays);
    append(bits, rays.direction_x), append(bits, rays.valid);
    refine_tile(m, {1, 2, 3}, {0.1, 0.2, -2}, directions, planes, depth, surface);
    append(bits, surface.depth_m), append(bits, surface.x), append(bits, surface.z),
        append(bits, surface.slope);
    fill(points.x, 0), fill(points.y, 0), fill(points.z, 1), fill(points.margin_m, 0),
        fill(points.front, 0.5);
    fill(points.normal_x, 0), fill(points.normal_y, 0), fill(points.normal_z, 0);
    const LightTerms terms{{{9, 1, 2, 3}, {1, 9, 2, 3}, {0, 0, 1, 0.1}, 0.2, 1.8, 20, 10, 81, false},
                           m,
                           {0, 0, 1},
                           {1, 0, 0},
                           2,
                           3,
                           k % 2 == 0,
                           true,
                           true};
    project_tile(terms.lookup, points, pixels);
    light_tile(terms, points, pixels, light, rays);
    append(bits, pixels.u_px), append(bits, light.white_lx), append(bits, light.why),
        append(bits, rays.origin_y);
    append(bits, rays.direction_z), append(bits, rays.valid);
  }
  return bits;
}

TEST(InstructionSets, KernelsGiveTheSameBitsFromEach) {
  const testing::CapLifter lifter;
  const Bits widest[] = {noise_bits(), exposure_bits(), replay_bits(), tile_bits()};
  for (const std::string& name : testing::instruction_sets_here()) {
    cap_instruction_set(name);
    EXPECT_TRUE(noise_bits() == widest[0]) << name;
    EXPECT_TRUE(exposure_bits() == widest[1]) << name;
    EXPECT_TRUE(replay_bits() == widest[2]) << name;
    EXPECT_TRUE(tile_bits() == widest[3]) << name;
  }
}

CapturedStack captured(const Scene& scene) {
  const testing::Traced traced(scene);
  const BinaryPatternStack bits = make_binary_pattern_stack({scene.projectors[0].device.intrinsics.size});
  Sensor sensor;
  sensor.noise_sigma_dn = 1.5;
  return capture_stack(traced.surface, traced.light, scene.projectors[0], bits, 10,
                       make_exposure(sensor, 40, {1, 0, 0}));
}

TEST(InstructionSets, PicturesAgreeUpToTheTriangleThatIsNamedOnAnEdge) {
  // Embree rounds otherwise in each set, so that a ray on the edge of two triangles may be given to either:
  // the point moves by a rounding error, and a code may change where it lies on the edge of a projector
  // pixel; a silhouette or a shadow's edge may move by a ray's rounding error. Allowed: one pixel in 10,000.
  const testing::CapLifter lifter;
  const Scene scene = testing::scene_of(
      {testing::object_of(relief(2, 2, 0.3, 60, 60)), testing::object_of(sphere(0.3, 20), {0, 0, 0.5})},
      testing::device_at({0.3, 0.1, 3}, {0, 0, 0}, {400, 300}, 500),
      testing::device_at({-0.4, 0, 3}, {0, 0, 0}, {400, 300}, 500));
  const auto widest = std::get<ImageStack<std::uint8_t>>(captured(scene));
  for (const std::string& name : testing::instruction_sets_here()) {
    cap_instruction_set(name);
    const auto capped = std::get<ImageStack<std::uint8_t>>(captured(scene));
    std::size_t different = 0;
    for (std::size_t i = 0; i < capped.values.size(); ++i) different += capped.values[i] != widest.values[i];
    EXPECT_LE(double(different), 1e-4 * double(capped.values.size())) << name;
  }
}

}  // namespace
}  // namespace laterna
