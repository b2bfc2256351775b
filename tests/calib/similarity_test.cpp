#include "calib/similarity.h"

#include "sim/rigid.h"
#include "tests/testing.h"

#include <gtest/gtest.h>

#include <vector>

namespace laterna {
namespace {

struct Pairs {
  std::vector<glm::dvec3> a, b;
};

Pairs pairs_of(const Similarity& truth, std::size_t count, bool flat = false) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> unit(-1, 1);
  Pairs pairs;
  for (std::size_t i = 0; i < count; ++i) {
    pairs.a.emplace_back(unit(random), unit(random), flat ? 0 : unit(random));
    pairs.b.push_back(apply(truth, pairs.a.back()));
  }
  return pairs;
}

double worst(const Similarity& fit, const Pairs& pairs, std::size_t first = 0) {
  double most = 0;
  for (std::size_t i = first; i < pairs.a.size(); ++i)
    most = std::max(most, glm::distance(apply(fit, pairs.a[i]), pairs.b[i]));
  return most;
}

const Rigid motion = rigid_from_rotation_vector({0.3, -2, 0.7}, {5, -3, 1});

TEST(Similarity, ExactPairsComeBackToRounding) {
  for (const bool flat : {false, true}) {
    const Similarity truth{0.001, motion.rotation, motion.translation};
    const auto fit = fit_similarity(pairs_of(truth, 50, flat).a, pairs_of(truth, 50, flat).b, {true, true});
    ASSERT_TRUE(fit);
    EXPECT_LT(worst(*fit, pairs_of(truth, 50, flat)), 1e-12);  // some roundings of numbers below 10
    EXPECT_NEAR(fit->scale, 0.001, 1e-14);
  }
}

TEST(Similarity, WhatIsNotAskedForStays) {
  const Pairs moved = pairs_of({2, motion.rotation, motion.translation}, 50);
  const auto rigid = fit_similarity(moved.a, moved.b, {true, false});
  ASSERT_TRUE(rigid);
  EXPECT_EQ(rigid->scale, 1);
  const Pairs scaled = pairs_of({2}, 50);
  const auto scale = fit_similarity(scaled.a, scaled.b, {false, true});
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->scale, 2, 1e-14);
  EXPECT_EQ(scale->rotation, glm::dmat3(1.0));
  EXPECT_EQ(scale->translation, glm::dvec3(0.0));
}

TEST(Similarity, FourOfTenWrongPairsHoldNoSway) {
  const Similarity truth{1, motion.rotation, motion.translation};
  Pairs pairs = pairs_of(truth, 500);
  auto random = testing::generator();
  std::uniform_real_distribution<double> far(-1000, 1000);
  for (std::size_t i = 0; i < 200; ++i) pairs.b[i] = {far(random), far(random), far(random)};
  const auto fit = fit_similarity(pairs.a, pairs.b);
  ASSERT_TRUE(fit);
  // Weights of wrong pairs: below (3·median/1000)⁴ of what is exact otherwise.
  EXPECT_LT(worst(*fit, pairs, 200), 1e-9);
}

TEST(Similarity, APairOrALineTellsNoMotion) {
  Pairs line;
  for (int i = 0; i < 10; ++i) line.a.emplace_back(i, 2 * i, -i), line.b.emplace_back(i, 0, 0);
  EXPECT_FALSE(fit_similarity(line.a, line.b));
  EXPECT_FALSE(fit_similarity(std::span(line.a).first(2), std::span(line.b).first(2)));
}

TEST(Similarity, AMirrorIsNoRotation) {
  Pairs pairs = pairs_of({}, 50);
  for (glm::dvec3& x : pairs.b) x.y = -x.y;
  const auto fit = fit_similarity(pairs.a, pairs.b);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(glm::determinant(fit->rotation), 1, 1e-12);
  EXPECT_GT(worst(*fit, pairs), 0.1);
}

}  // namespace
}  // namespace laterna
