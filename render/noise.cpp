#include "render/noise.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace laterna {

void normal_deviates(const NoiseKey& key, std::uint32_t pixel, std::uint32_t group, float deviates[4]) {
  const r123::Philox4x32::ctr_type counter{{pixel, group, key.camera, key.projector}};
  const r123::Philox4x32::key_type philox_key{{std::uint32_t(key.seed), std::uint32_t(key.seed >> 32)}};
  const r123::Philox4x32::ctr_type bits = r123::Philox4x32()(counter, philox_key);
  for (int i = 0; i < 4; i += 2) {
    const float uniform = (float(bits[i] >> 8) + 0.5f) * 0x1p-24f;  // in (0, 1)
    const float angle = 2 * std::numbers::pi_v<float> * (float(bits[i + 1] >> 8) * 0x1p-24f);
    const float radius = std::sqrt(-2 * std::log(uniform));
    deviates[i] = radius * std::cos(angle);
    deviates[i + 1] = radius * std::sin(angle);
  }
}

}  // namespace laterna
