#include "calib/boards/rig_splines.h"

#include "calib/splined_lens.h"
#include "sim/lens.h"
#include "sim/spline_knots.h"

namespace laterna {

DeviceTerms lean_terms(DeviceTerms terms) {
  for (auto& of_device : terms)
    if (are_splined(of_device)) of_device = lens_terms("k1k2p1p2");
  return terms;
}

BoardRig with_splines(const RigFit& lean, DeviceTerms& terms) {
  BoardRig rig = lean.adjustment.rig;
  for (std::size_t d = 0; d < terms.size(); ++d) {
    if (!are_splined(terms[d]) || lean.capture.devices[d].known) continue;
    const Device device = device_of(rig, lean.model, lean.capture, int(d));
    if (terms[d][0] == "splined") terms[d][0] = spline_over_image(device);
    rig.devices[d].parameters = spline_like(device, terms[d][0]);
  }
  return rig;
}

void add_spline_priors(RigModel& model, const BoardRig& rig) {
  for (std::size_t d = 0; d < model.devices.size(); ++d) {
    DeviceModel& device = model.devices[d];
    if (is_splined(device.lens_model) && device.held_core)
      device.prior = spline_prior(rig.devices[d].parameters);
  }
}

}  // namespace laterna
