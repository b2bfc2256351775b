#include "sim/sensor.h"

#include "sim/error.h"
#include "sim/field_text.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string_view>

namespace laterna {

namespace {

/// Refuses numbers outside the range of their description.
struct RangeCheck {
  template <class T>
  void operator()(const Field& field, const T& value) const {
    if constexpr (is_optional<T>) {
      if (value) (*this)(field, *value);
    } else if constexpr (std::is_arithmetic_v<T>) {
      if (!in_range(field, double(value)))
        throw InputError(fmt::format("sensor: {} is {}, expected {}", field.key, value, range_text(field)));
    }
  }
};

void check_kind(const Sensor& sensor) {
  const bool ideal = sensor.kind == SensorKind::ideal;
  for (const FieldText& field : changed_field_texts(sensor)) {
    const std::string_view key = field.key;
    if (key == "kind" || key == "bit_depth" || key == "saturation_cd_per_m2") continue;
    if ((key == "noise_sigma_dn") == ideal) continue;
    throw InputError(fmt::format("sensor: {} is given, but kind is \"{}\", expected kind = \"{}\"", key,
                                 ideal ? "ideal" : "emva1288", ideal ? "emva1288" : "ideal"));
  }
}

}  // namespace

void check(const Sensor& sensor) {
  const RangeCheck visit;
  Sensor visited = sensor;
  describe(visit, visited);
  check_kind(sensor);
  if (sensor.kind == SensorKind::ideal) return;
  if (sensor.saturation_cd_per_m2 && sensor.exposure_time_s)
    throw InputError(
        "sensor: saturation_cd_per_m2 and exposure_time_s are both given, expected at most one of them");
  if (!(sensor.black_offset_dn < full_scale_dn(sensor)))
    throw InputError(fmt::format("sensor: black_offset_dn is {}, expected less than the full scale, {}",
                                 sensor.black_offset_dn, full_scale_dn(sensor)));
}

double system_gain_dn_per_e(const Sensor& sensor) {
  return sensor.system_gain_dn_per_e.value_or((full_scale_dn(sensor) - sensor.black_offset_dn) /
                                              sensor.full_well_e);
}

double capacity_e(const Sensor& sensor) {
  return std::min((full_scale_dn(sensor) - sensor.black_offset_dn) / system_gain_dn_per_e(sensor),
                  sensor.full_well_e);
}

double electrons_per_s_and_cd_per_m2(const Sensor& sensor) {
  constexpr double planck_j_s = 6.62607015e-34, light_m_per_s = 299792458;  // exact in the SI
  const double irradiance_lx =
      std::numbers::pi / 4 * sensor.lens_transmission / (sensor.f_number * sensor.f_number);
  const double power_w =
      irradiance_lx / sensor.luminous_efficacy_lm_per_w * sensor.pixel_pitch_m * sensor.pixel_pitch_m;
  const double photons_per_s = power_w * sensor.wavelength_m / (planck_j_s * light_m_per_s);
  return sensor.quantum_efficiency * photons_per_s;
}

double exposure_time_s(const Sensor& sensor, double saturation_cd_per_m2) {
  return capacity_e(sensor) /
         (electrons_per_s_and_cd_per_m2(sensor) * saturation_cd_per_m2 + sensor.dark_current_e_per_s);
}

std::optional<double> fixed_saturation_cd_per_m2(const Sensor& sensor) {
  if (sensor.kind == SensorKind::ideal || !sensor.exposure_time_s) return sensor.saturation_cd_per_m2;
  const double dark_e = sensor.dark_current_e_per_s * *sensor.exposure_time_s, capacity = capacity_e(sensor);
  if (!(dark_e < capacity))
    throw InputError(
        fmt::format("sensor: exposure_time_s is {}, but the dark current fills the scale within {:.6g} s",
                    *sensor.exposure_time_s, capacity / sensor.dark_current_e_per_s));
  return (capacity - dark_e) / (electrons_per_s_and_cd_per_m2(sensor) * *sensor.exposure_time_s);
}

}  // namespace laterna
