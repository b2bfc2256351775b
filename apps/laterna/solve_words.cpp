#include "apps/laterna/solve_words.h"

#include <map>

namespace laterna {

void add_solve_words(CLI::App& command, SolveOptions& options) {
  const std::map<std::string, RobustLoss::Kind> losses{{"none", RobustLoss::Kind::none},
                                                       {"huber", RobustLoss::Kind::huber},
                                                       {"cauchy", RobustLoss::Kind::cauchy}};
  command
      .add_option("--tolerance-px", options.tolerance_px,
                  "Weak where the predicted error over the volume is above this")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  command
      .add_option("--loss", options.loss.kind, "none, huber or cauchy: how outliers count (default: none)")
      ->transform(CLI::CheckedTransformer(losses));
  command.add_option("--loss-scale", options.loss.scale_sigmas, "Where the loss bends, in sigmas")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
}

}  // namespace laterna
