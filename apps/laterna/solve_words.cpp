#include "apps/laterna/solve_words.h"

#include <cmath>
#include <map>
#include <string>

namespace laterna {

void add_solve_words(CLI::App& command, SolveOptions& options) {
  const CLI::Validator positive(
      [](std::string& text) {
        double value = 0;
        const bool number = CLI::detail::lexical_cast(text, value);
        return number && value > 0 && std::isfinite(value)
                   ? ""
                   : "found \"" + text + "\", expected a number above 0";
      },
      "ABOVE 0");
  const std::map<std::string, RobustLoss::Kind> losses{{"none", RobustLoss::Kind::none},
                                                       {"huber", RobustLoss::Kind::huber},
                                                       {"cauchy", RobustLoss::Kind::cauchy}};
  command
      .add_option("--tolerance-px", options.tolerance_px,
                  "Weak where the predicted error over the volume is above this")
      ->capture_default_str()
      ->check(positive);
  command
      .add_option("--loss", options.loss.kind, "none, huber or cauchy: how outliers count (default: none)")
      ->transform(CLI::Validator(
          [losses](std::string& text) {
            const auto found = losses.find(text);
            if (found == losses.end()) return "found \"" + text + "\", expected none, huber or cauchy";
            text = std::to_string(int(found->second));
            return std::string();
          },
          "none|huber|cauchy"));
  command.add_option("--loss-scale", options.loss.scale_sigmas, "Where the loss bends, in sigmas")
      ->capture_default_str()
      ->check(positive);
}

}  // namespace laterna
