// Correspondences alone, as a person would self-calibrate from them.
#include "sim/rigid.h"
#include "tests/command/run_command.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using testing::laterna;
using testing::ScratchFolder;
using testing::write_text;

struct TableOptions {
  int places = 3;  // of the projector
  double relief = 0.6, k1_camera = 0, k1_projector = 0;
  int points = 60;
  bool scene_moved = false;  // odd points have a station of the projector of their own, in the same place
};

// A known camera (f 1500) and a projector (f 1700, centre 512, 700) in some places around a scene 2.2 m away,
// to rounding at 1e-9 px, with a sigma of 0.05 px.
std::string table(const TableOptions& o = {}) {
  auto random = testing::generator();
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  const auto place = [](const glm::dvec3& at, const glm::dvec3& target, double roll) {
    return compose(rigid_from_rotation_vector({0, 0, roll}, glm::dvec3(0.0)),
                   device_from_world_looking_at(at, target, {0, -1, 0}));
  };
  std::vector<Rigid> places{
      place({0, 0, 0}, {0.02, 0.1, 2.2}, 0), place({0.8, 0.1, 0.2}, {0, -0.3, 2.2}, 0.1),
      place({-0.7, -0.5, 0}, {0.1, -0.2, 2.3}, 1.3), place({0.2, 0.7, 0.3}, {0, -0.2, 2.1}, -0.6)};
  places.resize(1 + std::size_t(o.places));
  std::string text = "point,device,station,x,y,sigma_px\n";
  for (int p = 0; p < o.points; ++p) {
    const double x = 1.2 * uniform(random), y = 0.8 * uniform(random);
    const glm::dvec3 x_world(x, y, 2.2 + 0.2 * x + o.relief * uniform(random));
    for (std::size_t s = 0; s < places.size(); ++s) {
      const glm::dvec3 at = apply(places[s], x_world);
      const glm::dvec2 n(at.x / at.z, at.y / at.z);
      const double bent = 1 + (s == 0 ? o.k1_camera : o.k1_projector) * glm::dot(n, n);
      const double f = s == 0 ? 1500 : 1700, cx = s == 0 ? 660 : 512, cy = s == 0 ? 500 : 700;
      text += fmt::format("{},{},{},{:.9f},{:.9f},0.05\n", p, s == 0 ? "camera" : "projector",
                          o.scene_moved && s > 0 && p % 2 ? 9 : s, f * bent * n.x + cx, f * bent * n.y + cy);
    }
  }
  return text;
}

const std::string sizes = "--size camera=1280x1024 --size projector=1024x768 ";
const std::string camera = "--known camera=1500,1500,660,500 ";
const std::string whole = "selfcal t.csv " + sizes + camera + "--assume projector=focal+center ";

class Selfcal : public ::testing::Test {
 protected:
  ScratchFolder scratch;
  auto run(const std::string& words, const std::string& text = table()) {
    write_text(scratch / "t.csv", text);
    return laterna(words, scratch.path());
  }
  void expect_bad(const std::string& words, const std::string& sentence, const std::string& text = table()) {
    const auto result = run(words, text);
    EXPECT_EQ(result.exit_code, 2) << words << "\n" << result.out;
    EXPECT_THAT(result.err, HasSubstr(sentence));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(testing::listing(scratch.path()).find("result"), std::string::npos) << words;
  }
  void expect_refused(const std::string& words, const std::string& reason, const std::string& text) {
    const auto result = run(words + " --json", text);
    EXPECT_EQ(result.exit_code, 3) << words << "\n" << result.out << result.err;
    const json j = json::parse(result.out);
    EXPECT_EQ(j.at("status"), "refused");
    EXPECT_THAT(j.at("reason").get<std::string>(), HasSubstr(reason));
    EXPECT_TRUE(j.at("devices").empty());
  }
};

TEST_F(Selfcal, AKnownCameraAndAProjectorInThreePlaces) {
  const auto result = run(whole + "--json -o result.json");
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const json j = json::parse(result.out);
  EXPECT_EQ(j, json::parse(testing::read_text(scratch / "result.json")));
  EXPECT_EQ(j.at("status"), "ok");
  EXPECT_EQ(j.at("reason"), "");
  EXPECT_EQ(j.at("count"), json({{"given", 29}, {"needed", 20}, {"intrinsics", 3}, {"places", 17}}));
  const json& projector = j.at("devices").at(1);
  EXPECT_EQ(projector.at("name"), "projector");
  EXPECT_EQ(projector.at("size"), json({1024, 768}));
  // Pixels rounded to 1e-9, through a condition number of some 1e4.
  EXPECT_NEAR(projector.at("fx").get<double>(), 1700, 1e-3);
  EXPECT_NEAR(projector.at("cy").get<double>(), 700, 1e-3);
  EXPECT_EQ(projector.at("lens"), json({{"model", "LENSMODEL_PINHOLE"}, {"parameters", json::array()}}));
  EXPECT_EQ(j.at("stations").size(), 4u);
  EXPECT_EQ(j.at("covariance").size(), j.at("parameters").size() * j.at("parameters").size());
  EXPECT_EQ(j.at("unit"), "baseline");
  EXPECT_EQ(run(whole + "--length 3,17,0.5").exit_code, 0);
  EXPECT_THAT(run(whole).out, HasSubstr("verdict: ok"));
}

TEST_F(Selfcal, LensesByWordByClimbAndByFile) {
  TableOptions lens;
  lens.k1_projector = -0.12;
  const std::string text = table(lens);
  const auto pinhole = run(whole, text);
  EXPECT_EQ(pinhole.exit_code, 4) << pinhole.out;
  EXPECT_THAT(pinhole.out, HasSubstr("the residuals follow a lens that was not asked for"));
  for (const char* word : {"--lens projector=k1 --json", "--lens auto --json"}) {
    const auto result = run(whole + word, text);
    ASSERT_EQ(result.exit_code, 0) << word << result.out << result.err;
    const json j = json::parse(result.out), found = j.at("devices").at(1).at("lens");
    EXPECT_EQ(found.at("model"), "LENSMODEL_OPENCV4");
    EXPECT_NEAR(found.at("parameters").at(0).get<double>(), -0.12, 1e-5);
    EXPECT_EQ(j.at("ladder").empty(), std::string(word).find("auto") == std::string::npos);
  }
  lens = {};
  lens.k1_camera = -0.2;
  write_text(scratch / "camera.cameramodel",
             "{ 'lensmodel': 'LENSMODEL_OPENCV4', 'intrinsics': [ 1500, 1500, 660, 500, -0.2, 0, 0, 0 ],\n"
             "'extrinsics': [ 0, 0, 0, 0, 0, 0 ], 'imagersize': [ 1280, 1024 ] }\n");
  const auto known =
      run("selfcal t.csv --size projector=1024x768 --known camera=camera.cameramodel "
          "--assume projector=focal+center --json",
          table(lens));
  ASSERT_EQ(known.exit_code, 0) << known.out << known.err;
  EXPECT_NEAR(json::parse(known.out).at("devices").at(1).at("fx").get<double>(), 1700, 1e-3);
}

TEST_F(Selfcal, RefusalsSayWhy) {
  TableOptions flat, pair, few;
  flat.relief = 0, flat.places = 1, pair.places = 1, few.places = 1, few.points = 6;
  const std::string focal =
      "selfcal t.csv " + sizes + camera + "--assume projector=focal --center projector=512,700";
  expect_refused(focal, "the scene is a plane", table(flat));
  expect_refused(focal, "too few points", table(few));
  expect_refused(whole,
                 "one pair gives 7 numbers; known camera with unknown f, c_x, c_y of projector needs 8",
                 table(pair));
  expect_refused(whole + "--lens k1", "one pair gives 8 numbers", table(pair));
  pair.scene_moved = true;
  expect_refused(whole, "only the scene moved; one pair gives 7 numbers", table(pair));
}

TEST_F(Selfcal, BadInputIsOneSentence) {
  expect_bad("selfcal nothing.csv " + sizes, "nothing.csv");
  expect_bad("selfcal t.csv -o result.json " + camera, "--size camera=WIDTHxHEIGHT is missing");
  expect_bad("selfcal t.csv -o result.json " + sizes + camera,
             "projector: found none of --known and --assume, expected one of them");
  expect_bad(whole + "--known projector=1,1,1,1", "projector: found both of --known and --assume");
  expect_bad(whole + "--known beamer=1,1,1,1", "--known: there is no device \"beamer\"");
  expect_bad(whole + "--lens beamer=k1", "--lens: there is no device \"beamer\"");
  expect_bad(whole + "--lens projector=fisheye",
             "projector: lens is \"fisheye\", expected auto, pinhole, k1");
  expect_bad(whole + "--lens k1 --lens auto", "expected one word for all devices");
  expect_bad(whole + "--length 3,nowhere,0.5", "--length: found \"3,nowhere,0.5\"");
  expect_bad("selfcal t.csv " + sizes + "--known camera=no.cameramodel --assume projector=focal",
             "no.cameramodel");
  expect_bad(whole, "t.csv: line 2: y is \"oops\"", "point,device,station,x,y\n1,camera,0,1,oops\n");
  expect_bad(whole, "t.csv", "");
}

}  // namespace
}  // namespace laterna
