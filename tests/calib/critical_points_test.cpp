#include "calib/critical_points.h"

#include "calib/solve.h"
#include "sim/device.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

using namespace laterna;
using namespace laterna::testing;
using ::testing::HasSubstr;
using ::testing::Not;

namespace {

// Before a projector at the origin that looks along z.
struct Shape {
  CriticalSet set;
  std::vector<glm::dvec3> points;
};

std::vector<Shape> shapes(std::mt19937_64& random, double off) {
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  std::vector<Shape> all{{CriticalSet::none, {}},  // a slab
                         {CriticalSet::none, {}},  // a plane
                         {CriticalSet::twisted_cubic, {}},
                         {CriticalSet::plane_and_line, {}}};
  for (int i = 0; i < 300; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random), t = 0.65 + 0.7 * z;
    const glm::dvec3 beside = off * glm::dvec3(uniform(random), uniform(random), uniform(random));
    all[0].points.emplace_back(x, y, 2 + z);
    all[1].points.push_back(glm::dvec3(x, y, 2 + 0.3 * x) + beside);
    all[2].points.push_back(2.8 * t * glm::dvec3(0.5 * t - 0.3, 0.4 * t * t - 0.2, 1) +
                            beside);  // t = 0: centre
    all[3].points.push_back((i % 2 ? glm::dvec3(x, y, 2 + 0.3 * x) : (2 + z) * glm::dvec3(0.05, 0.1, 1)) +
                            beside);
  }
  return all;
}

TEST(CriticalSet, EachShapeIsTold) {
  auto random = generator();
  for (const double off : {0.0, 1e-3})
    for (const Shape& s : shapes(random, off))
      EXPECT_EQ(critical_set(s.points), s.set) << int(s.set) << " " << off;
  EXPECT_EQ(critical_set(std::vector<glm::dvec3>(5)), CriticalSet::none);
}

TEST(CriticalSet, FarFromTheOriginAndSmallTheSame) {
  auto random = generator();
  for (Shape& s : shapes(random, 0)) {
    for (glm::dvec3& x : s.points) x = 0.01 * x + glm::dvec3(100, -200, 50);
    EXPECT_EQ(critical_set(s.points), s.set) << int(s.set);
  }
}

// A projector whose centre is on a twisted cubic slides along it: never ok, and the reason is the true one.
TEST(CriticalSet, SolveSaysIt) {
  auto random = generator();
  std::normal_distribution<double> normal;
  Device truth;
  truth.intrinsics = {{1024, 768}, 1400, 1400, 500, 400};
  const WorldProjection projection(truth);
  const std::vector<Shape> all = shapes(random, 0);
  for (const Shape* s : {&all[0], &all[2]}) {
    Correspondences c;
    for (const glm::dvec3& x : s->points) {
      c.world_points.push_back(x);
      const double du = 0.1 * normal(random);
      c.projector_pixels.push_back(glm::dvec2(projection.project(x)) + glm::dvec2(du, 0.1 * normal(random)));
      c.sigma_px.push_back(0.1);
    }
    const SolveResult r = solve(c, truth.intrinsics.size);
    const bool critical = s->set == CriticalSet::twisted_cubic;
    EXPECT_EQ(r.status == Status::ok, !critical) << r.reason;
    EXPECT_THAT(r.reason, Not(HasSubstr("too flat")));
    if (critical) {
      EXPECT_THAT(r.reason, HasSubstr("a twisted cubic through the projector's centre"));
    }
  }
}

}  // namespace
