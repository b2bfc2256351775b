#include "tests/lab/score/picture_scenes.h"

#include "tests/lab/score/random_rigs.h"

#include <fmt/format.h>
#include <glm/glm.hpp>

#include <array>
#include <cmath>

namespace laterna::testing {

namespace {

// Before the relief's middle, which faces +z; `side` 1 is right of it.
glm::dvec3 place(double side, std::mt19937_64& random) {
  const double distance = uniform(random, 1.8, 2.4);
  const double across = side * uniform(random, 0.12, 0.4), up = uniform(random, -0.3, 0.3);
  return distance * glm::normalize(glm::dvec3(across, up, 1));
}

std::string position_and_target(const glm::dvec3& position, double lower_m, std::mt19937_64& random) {
  return fmt::format("position = [{}, {}, {}]\nlook_at = [{}, {}, 0.0]\nup = [{}, 1.0, 0.0]\n", position.x,
                     position.y - lower_m, position.z, uniform(random, -0.05, 0.05), -lower_m,
                     uniform(random, -0.15, 0.15));
}

std::string projector(double side, std::mt19937_64& random) {
  static constexpr std::array<glm::ivec2, 6> sizes{
      {{160, 120}, {128, 96}, {160, 100}, {192, 108}, {128, 128}, {120, 160}}};
  const glm::ivec2 size = sizes[one_of(random, sizes.size())];
  const double throw_ratio = uniform(random, 1.1, 1.6) * std::max(1.0, double(size.y) / size.x);
  const glm::dvec3 position = place(side, random);
  const double shift = one_of(random, 3) == 0 ? 0.5 : uniform(random, -0.1, 0.1);
  // A shifted picture is held where it was by a projector that is lower.
  const double lower_m = shift * size.y * glm::length(position) / (throw_ratio * size.x);
  const std::string lens =
      one_of(random, 2) == 0
          ? fmt::format("lens = {{ model = \"LENSMODEL_OPENCV4\", parameters = [{}, 0.0, 0.0, 0.0] }}\n",
                        uniform(random, -0.05, 0.05))
          : "";
  return fmt::format(
             "[[projector]]\nname = \"projector\"\nsize = [{}, {}]\nthrow_ratio = {}\nlens_shift = [{}, "
             "{}]\n",
             size.x, size.y, throw_ratio, uniform(random, -0.03, 0.03), shift) +
         lens + position_and_target(position, lower_m, random);
}

std::string camera(double side, std::mt19937_64& random) {
  const std::string sensor = one_of(random, 2) == 0
                                 ? "{ kind = \"emva1288\" }"
                                 : fmt::format("{{ noise_sigma_dn = {} }}", uniform(random, 0.3, 1.5));
  return fmt::format(
             "[[camera]]\nname = \"camera\"\nsize = [{}, {}]\nfov_x_deg = {}\nsamples_per_pixel = 4\nsensor "
             "= {}\n",
             180 + 10 * one_of(random, 5), 120 + 10 * one_of(random, 3), uniform(random, 40, 46), sensor) +
         position_and_target(place(side, random), 0, random);
}

std::string patterns(int family, std::mt19937_64& random) {
  static constexpr std::array<const char*, 6> kinds{"gray",  "gray_phase",      "xor_gray",
                                                    "phase", "multi_frequency", "micro_phase"};
  return fmt::format("[patterns]\nkind = \"{}\"\nsteps = {}\npitch_px = {}\n", kinds[family % kinds.size()],
                     3 + one_of(random, 3), 16 + 8 * one_of(random, 3));
}

}  // namespace

std::string picture_scene(int family, std::mt19937_64& random) {
  const double side = one_of(random, 2) == 0 ? 1 : -1;
  const std::string blur = one_of(random, 2) == 0 ? "[effects]\nantialiasing = true\n" : "";
  return blur +
         fmt::format("[[mesh]]\nshape = \"relief\"\nshape_size = [1.6, 1.0, {}]\ndetail = 60\nseed = {}\n",
                     uniform(random, 0.4, 0.8), one_of(random, 1000)) +
         projector(side, random) + camera(-side, random) + patterns(family, random);
}

}  // namespace laterna::testing
