// The fields of a scene file (sim/scene_fields.h): a camera's sensor.
#pragma once

#include "sim/fields.h"
#include "sim/fields/names.h"
#include "sim/scene_spec.h"

namespace laterna {

template <class Visitor>
void describe_emva1288(Visitor& visit, Sensor& sensor) {
  visit(Field{.key = "exposure_time_s",
              .unit = "s",
              .sentence = "With emva1288: the exposure time. Absent: what saturation_cd_per_m2, or automatic "
                          "exposure, needs.",
              .low = 1e-12,
              .high = 1e6},
        sensor.exposure_time_s);
  visit(Field{.key = "f_number",
              .sentence = "With emva1288: focal length over aperture: E = π/4·L·lens_transmission/f_number².",
              .low = 0.1,
              .high = 1e4},
        sensor.f_number);
  visit(Field{.key = "lens_transmission",
              .sentence = "With emva1288: light behind over light in front of the lens.",
              .low = 1e-6,
              .high = 1},
        sensor.lens_transmission);
  visit(Field{.key = "pixel_pitch_m",
              .unit = "m",
              .sentence = "With emva1288: side of a square pixel.",
              .low = 1e-7,
              .high = 1e-2},
        sensor.pixel_pitch_m);
  visit(Field{.key = "quantum_efficiency",
              .sentence = "With emva1288: electrons per photon on the pixel.",
              .low = 1e-6,
              .high = 1},
        sensor.quantum_efficiency);
  visit(Field{.key = "wavelength_m",
              .unit = "m",
              .sentence = "With emva1288: of the light, for the energy of a photon.",
              .low = 1e-7,
              .high = 1e-5},
        sensor.wavelength_m);
  visit(Field{.key = "luminous_efficacy_lm_per_w",
              .unit = "lm/W",
              .sentence = "With emva1288: of the light; 683 at 555 nm, of white light some 250.",
              .low = 1e-3,
              .high = 684},
        sensor.luminous_efficacy_lm_per_w);
  visit(Field{.key = "full_well_e",
              .unit = "e-",
              .sentence = "With emva1288: the most electrons that a pixel holds.",
              .low = 1,
              .high = 1e9},
        sensor.full_well_e);
  visit(Field{.key = "system_gain_dn_per_e",
              .unit = "DN/e-",
              .sentence = "With emva1288: K. Absent: the full well fills the scale.",
              .low = 1e-6,
              .high = 1e6},
        sensor.system_gain_dn_per_e);
  visit(Field{.key = "dark_noise_e",
              .unit = "e-",
              .sentence = "With emva1288: standard deviation of the read-out noise, that of the dark current "
                          "not included.",
              .low = 0,
              .high = 1e6},
        sensor.dark_noise_e);
  visit(Field{.key = "dark_current_e_per_s",
              .unit = "e-/s",
              .sentence = "With emva1288: electrons without light.",
              .low = 0,
              .high = 1e9},
        sensor.dark_current_e_per_s);
  visit(Field{.key = "black_offset_dn",
              .unit = "DN",
              .sentence = "With emva1288: the signal without electrons; less than the full scale.",
              .low = 0,
              .high = 65535},
        sensor.black_offset_dn);
  visit(Field{.key = "dsnu_e",
              .unit = "e-",
              .sentence = "With emva1288: dark signal non-uniformity: standard deviation over the pixels, "
                          "the same in every picture.",
              .low = 0,
              .high = 1e6},
        sensor.dsnu_e);
  visit(Field{.key = "prnu",
              .sentence = "With emva1288: photo response non-uniformity: relative standard deviation over "
                          "the pixels, the same in every picture.",
              .low = 0,
              .high = 1},
        sensor.prnu);
  visit(Field{.key = "nonuniformity_seed",
              .sentence = "With emva1288: draws DSNU and PRNU, with the number of the camera.",
              .low = 0},
        sensor.nonuniformity_seed);
  visit(Field{.key = "response_exponent",
              .sentence = "With emva1288: DN = full_scale·(y/full_scale)^response_exponent of the linear "
                          "signal y; 1 is linear, 1/2.2 brightens.",
              .low = 0.1,
              .high = 10},
        sensor.response_exponent);
}

template <class Visitor>
void describe(Visitor& visit, Sensor& sensor) {
  visit(Field{.key = "kind",
              .sentence =
                  "ideal: linear, with Gaussian noise. emva1288: the linear camera model of EMVA 1288."},
        sensor.kind);
  visit(Field{.key = "bit_depth",
              .unit = "bit",
              .sentence = "Full scale is 2^bit_depth - 1 DN; 9 to 16 bits go to 16-bit files.",
              .low = 8,
              .high = 16},
        sensor.bit_depth);
  visit(Field{.key = "noise_sigma_dn",
              .unit = "DN",
              .sentence = "With ideal: standard deviation of Gaussian noise, added before rounding.",
              .low = 0,
              .high = 65535},
        sensor.noise_sigma_dn);
  visit(Field{.key = "saturation_cd_per_m2",
              .unit = "cd/m²",
              .sentence = "The luminance that fills the scale. Absent: automatic exposure.",
              .low = 0,
              .high = 1e12,
              .low_excluded = true},
        sensor.saturation_cd_per_m2);
  describe_emva1288(visit, sensor);
}

}  // namespace laterna
