#include "calib/boards/stepwise.h"

#include "calib/boards/adjust.h"

namespace laterna {

std::optional<BoardRig> adjust_stepwise(const BoardCapture& capture, const RigModel& model,
                                        const BoardRig& start) {
  RigModel camera = model, others = model;
  for (std::size_t d = 0; d < model.devices.size(); ++d) (d == 0 ? others : camera).devices[d].held = true;
  others.hold_poses = true;
  others.bend = false;
  const auto first = adjust({seen_by(capture, 0), camera}, fitted_to(start, model, capture));
  if (!first || !first->converged) return std::nullopt;
  BoardCapture rest = capture;
  std::erase_if(rest.sightings, [](const Sighting& s) { return s.device == 0; });
  const auto second = adjust({rest, others}, first->rig);
  if (!second || !second->converged) return std::nullopt;
  return second->rig;
}

}  // namespace laterna
