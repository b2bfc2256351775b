#include "apps/lab/selfcal_report.h"

#include "tests/testing.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace laterna {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

// A camera and a projector with one free focal length and one free k1, written by hand.
SelfCalibration by_hand() {
  SelfCalibration c;
  c.status = Status::weak;
  c.reason = "because";
  c.count.given = 8, c.count.intrinsics = 2, c.count.places = 5;
  c.tracks.devices = {{"camera", {{640, 480}, 600, 600, 320, 240}, false, false, false},
                      {"projector", {{320, 200}, 0, 0, 160, 100}, true, false, false}};
  c.tracks.devices[1].lens = {"LENSMODEL_OPENCV4", {0, 0, 0, 0}};
  c.tracks.devices[1].lens_free = {true, false, false, false};
  c.tracks.stations = {{0, "a"}, {1, "b"}};
  c.tracks.point_names = {"p"};
  c.rig.devices = {c.tracks.devices[0].intrinsics, {{320, 200}, 400, 400, 160, 100}};
  c.rig.lenses = {{}, {-0.125, 0, 0, 0}};
  c.rig.station_from_first = {{}, {glm::dmat3(1.0), {1, 0, 0}}};
  c.rig.points = {{0, 0, 2}};
  c.units = {{0, 1}};
  c.parameter_names = column_names(c.tracks);
  c.sigma.assign(c.parameter_names.size(), 0.5);
  c.covariance.assign(c.sigma.size() * c.sigma.size(), 0.0);
  c.stations = {{10, 0.25, 0}, {10, 0.5, INFINITY}};
  c.dropped = {{{0, 1, {3, 4}, 1}, INFINITY}};
  c.weakest_direction = "projector f and projector k1 trade off";
  c.ladder.rungs.resize(2);
  c.ladder.rungs[0].chosen = c.ladder.rungs[0].solved = true;
  c.ladder.rungs[1].added = "projector k1";
  return c;
}

TEST(SelfcalReport, JsonHoldsWhatItsHeaderSays) {
  const json j = selfcal_json(by_hand());
  EXPECT_EQ(j.at("status"), "weak");
  EXPECT_EQ(j.at("reason"), "because");
  EXPECT_EQ(j.at("count"), json({{"given", 8}, {"needed", 7}, {"intrinsics", 2}, {"places", 5}}));
  EXPECT_EQ(j.at("unit"), "baseline");
  EXPECT_EQ(j.at("unit_baselines"), json::parse(R"([["camera at a", "projector at b"]])"));
  const json& projector = j.at("devices").at(1);
  EXPECT_EQ(projector.at("lens"),
            json({{"model", "LENSMODEL_OPENCV4"}, {"parameters", {-0.125, 0.0, 0.0, 0.0}}}));
  EXPECT_EQ(projector.at("sigma"), json({{"fx", 0.5}, {"fy", 0.5}, {"k1", 0.5}}));
  EXPECT_EQ(j.at("devices").at(0).at("lens").at("model"), "LENSMODEL_PINHOLE");
  EXPECT_TRUE(j.at("devices").at(0).at("sigma").empty());
  const json& station = j.at("stations").at(1);
  EXPECT_EQ(station.at("device_from_first"), json::parse("[[1,0,0,1],[0,1,0,0],[0,0,1,0]]"));
  EXPECT_TRUE(station.at("predicted_px").is_null());  // not finite
  EXPECT_EQ(j.at("parameters").size() * j.at("parameters").size(), j.at("covariance").size());
  EXPECT_EQ(j.at("parameters").at(1), "projector k1");
  EXPECT_EQ(j.at("ladder").at(1).at("added"), "projector k1");
  EXPECT_EQ(j.at("dropped").at(0).at("point"), "p");
  for (const char* key : {"fit_rms_px", "residual_scale", "focal_sigma", "lens_sigma", "merged", "iterations",
                          "termination", "weakest"})
    EXPECT_TRUE(j.contains(key)) << key;
}

TEST(SelfcalReport, RefusedHasNoDevices) {
  SelfCalibration c = by_hand();
  c.status = Status::refused;
  const json j = selfcal_json(c);
  EXPECT_TRUE(j.at("devices").empty());
  EXPECT_TRUE(j.at("stations").empty());
  EXPECT_TRUE(j.at("fit_rms_px").is_null());
  EXPECT_FALSE(j.contains("covariance"));
  EXPECT_THAT(selfcal_text(c), Not(HasSubstr("fx")));
}

TEST(SelfcalReport, TextSaysItToPeople) {
  const std::string text = selfcal_text(by_hand());
  EXPECT_THAT(text, HasSubstr("the pixels give 8 numbers; 7 are asked for"));
  EXPECT_THAT(text, HasSubstr("projector: fx 400.00 ± 0.5"));
  EXPECT_THAT(text, HasSubstr("k1 -0.12500 ± 0.5"));
  EXPECT_THAT(text, Not(HasSubstr("k2")));  // held at 0
  EXPECT_THAT(text, HasSubstr("cx 320.00 (held)"));
  EXPECT_THAT(text, HasSubstr("dropped as outliers: 1 sightings"));
  EXPECT_THAT(text, HasSubstr("the distance from camera at a to projector at b is 1"));
  EXPECT_THAT(text, HasSubstr("verdict: weak: because"));
}

}  // namespace
}  // namespace laterna
