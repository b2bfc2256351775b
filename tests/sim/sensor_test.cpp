#include "sim/sensor.h"

#include "sim/scene_file.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

namespace laterna {
namespace {

Sensor emva() {
  Sensor sensor;
  sensor.kind = SensorKind::emva1288;
  return sensor;
}

TEST(Sensor, ElectronsByHand) {
  Sensor s = emva();
  s.f_number = 2, s.lens_transmission = 1, s.pixel_pitch_m = 5e-6, s.quantum_efficiency = 0.5;
  // 1 cd/m²: π/16 = 0.1963495 lx, /683 = 2.874810e-4 W/m², ·25e-12 m² = 7.187024e-15 W; a photon of 555 nm
  // has 3.579182e-19 J: 20080.07 photons, half of them electrons. 1e-6: the digits above.
  EXPECT_NEAR(electrons_per_s_and_cd_per_m2(s), 10040.04, 0.01);
  const double reference = electrons_per_s_and_cd_per_m2(s);
  s.f_number = 4, s.pixel_pitch_m = 10e-6, s.wavelength_m = 1110e-9, s.lens_transmission = 0.5;
  EXPECT_NEAR(electrons_per_s_and_cd_per_m2(s) / reference, 1, 1e-14);  // /4 ·4 ·2 /2
}

TEST(Sensor, TheScaleIsFilledByTheFullWellOrByTheGain) {
  Sensor s = emva();
  s.bit_depth = 12, s.full_well_e = 10000, s.black_offset_dn = 95;
  EXPECT_DOUBLE_EQ(system_gain_dn_per_e(s), 0.4);
  EXPECT_DOUBLE_EQ(capacity_e(s), 10000);
  s.system_gain_dn_per_e = 2;
  EXPECT_DOUBLE_EQ(capacity_e(s), 2000);
  s.system_gain_dn_per_e = 0.1;
  EXPECT_DOUBLE_EQ(capacity_e(s), 10000);
}

TEST(Sensor, ExposureTimeAndSaturationAreInverse) {
  for (const double luminance : {0.01, 5.0, 3000.0}) {
    Sensor s = emva();
    EXPECT_FALSE(fixed_saturation_cd_per_m2(s));
    s.exposure_time_s = exposure_time_s(s, luminance);
    const double signal = (electrons_per_s_and_cd_per_m2(s) * luminance + s.dark_current_e_per_s);
    EXPECT_NEAR(signal * *s.exposure_time_s, capacity_e(s), 1e-9);  // rounding of 10500
    EXPECT_NEAR(fixed_saturation_cd_per_m2(s).value_or(0) / luminance, 1, 1e-12);
  }
  Sensor ideal;
  EXPECT_FALSE(fixed_saturation_cd_per_m2(ideal));
  ideal.saturation_cd_per_m2 = 7;
  EXPECT_EQ(fixed_saturation_cd_per_m2(ideal), 7);
}

TEST(Sensor, BadParametersAreNamed) {
  const auto error = [](auto&& change, SensorKind kind = SensorKind::emva1288) {
    Sensor s;
    s.kind = kind;
    change(s);
    return testing::input_error([&] { check(s); });
  };
  EXPECT_EQ(error([](Sensor& s) { s.bit_depth = 7; }), "sensor: bit_depth is 7, expected 8 to 16");
  EXPECT_EQ(error([](Sensor& s) { s.quantum_efficiency = 1.5; }),
            "sensor: quantum_efficiency is 1.5, expected 1e-06 to 1");
  EXPECT_EQ(error([](Sensor& s) { s.exposure_time_s = std::numeric_limits<double>::quiet_NaN(); }),
            "sensor: exposure_time_s is nan, expected 1e-12 to 1e+06");
  EXPECT_EQ(error([](Sensor& s) { s.black_offset_dn = 255; }),
            "sensor: black_offset_dn is 255, expected less than the full scale, 255");
  EXPECT_EQ(error([](Sensor& s) { s.exposure_time_s = 1, s.saturation_cd_per_m2 = 1; }),
            "sensor: saturation_cd_per_m2 and exposure_time_s are both given, expected at most one of them");
  EXPECT_EQ(error([](Sensor& s) { s.noise_sigma_dn = 1; }),
            "sensor: noise_sigma_dn is given, but kind is \"emva1288\", expected kind = \"ideal\"");
  EXPECT_EQ(error([](Sensor& s) { s.prnu = 0.01; }, SensorKind::ideal),
            "sensor: prnu is given, but kind is \"ideal\", expected kind = \"emva1288\"");
  Sensor warm = emva();
  warm.exposure_time_s = 100, warm.dark_current_e_per_s = 1000;
  EXPECT_EQ(testing::input_error([&] { fixed_saturation_cd_per_m2(warm); }),
            "sensor: exposure_time_s is 100, but the dark current fills the scale within 10.5 s");
}

TEST(Sensor, IsReadFromASceneAndWrittenBack) {
  const std::string scene =
      "[[mesh]]\nshape = \"plane\"\n[[camera]]\nsize = [64, 48]\nfx = 50\nposition = [0, -2, 0]\n"
      "look_at = [0, 0, 0]\n";
  const SceneSpec spec = parse_scene(
      scene + "sensor = { kind = \"emva1288\", bit_depth = 12, exposure_time_s = 0.02, prnu = 0.01 }\n", "s");
  const Sensor& sensor = spec.cameras.at(0).sensor;
  EXPECT_EQ(sensor.kind, SensorKind::emva1288);
  EXPECT_EQ(sensor.exposure_time_s, 0.02);
  EXPECT_EQ(sensor.full_well_e, Sensor{}.full_well_e);
  EXPECT_EQ(parse_scene(scene_toml(spec), "s"), spec);
  EXPECT_EQ(testing::input_error([&] { parse_scene(scene + "sensor = { prnu = 0.01 }\n", "s.toml"); }),
            "s.toml:8: sensor: prnu is given, but kind is \"ideal\", expected kind = \"emva1288\"");
  EXPECT_THAT(testing::input_error([&] { parse_scene(scene + "sensor = { kind = \"emva\" }\n", "s.toml"); }),
              ::testing::HasSubstr("one of \"ideal\", \"emva1288\""));
}

}  // namespace
}  // namespace laterna
