#include "apps/lab/dataset/data_card.h"

#include <fmt/format.h>

namespace laterna {

namespace {

std::string distribution_rows(const DatasetSpec& spec) {
  std::string rows = "| value of the scene | distribution |\n|---|---|\n";
  for (const RandomKey& key : spec.random)
    rows += fmt::format("| `{}` | {} |\n", key.path, distribution_text(key.distribution));
  for (const PresentKey& key : spec.present)
    rows += fmt::format("| `mesh.{}` | present with probability {} |\n", key.mesh, key.share);
  return rows;
}

std::string rejection_rows(const DatasetTotals& totals) {
  if (totals.rejected.empty()) return "No attempt was thrown away.\n";
  std::uint64_t all = totals.samples;
  for (const auto& [reason, count] : totals.rejected) all += count;
  std::string rows = "| reason | attempts | share |\n|---|---|---|\n";
  for (const auto& [reason, count] : totals.rejected)
    rows += fmt::format("| {} | {} | {:.1f} % |\n", reason, count, 100 * double(count) / double(all));
  return rows;
}

std::string cost_lines(const DatasetTotals& totals, const std::vector<RunCost>& costs) {
  if (costs.empty()) return "Not known: every run was killed.\n";
  std::string lines =
      "| threads of a run | samples timed | samples per second | CPU seconds a sample |\n|---|---|---|---|\n";
  for (const RunCost& cost : costs)
    lines += fmt::format("| {} | {} | {:.3g} | {:.3g} |\n", cost.threads, cost.samples,
                         double(cost.samples) / cost.wall_s, cost.cpu_s / double(cost.samples));
  return fmt::format(
      "{}\n{:.4g} MB a sample. {}. Runs of several shards at once add up, as far as processors and disk "
      "go.\n",
      lines, 1e-6 * double(totals.bytes) / double(totals.samples), million_text(totals, sum_of(costs)));
}

}  // namespace

std::string million_text(const DatasetTotals& totals, const RunCost& cost) {
  if (cost.samples == 0 || totals.samples == 0) return {};
  return fmt::format("A million samples: {:.3g} CPU-hours, {:.3g} TB of samples",
                     1e6 * cost.cpu_s / double(cost.samples) / 3600,
                     1e6 * double(totals.bytes) / double(totals.samples) * 1e-12);
}

std::string data_card(const DatasetSpec& spec, std::uint64_t seed, const DatasetTotals& totals,
                      const std::vector<RunCost>& costs) {
  return fmt::format(
      R"(# {}

{}

{} samples of seed {}, {} files, {:.4g} GB. Licence: {}. Made by `laterna dataset`; every picture is simulated.

## What is random

{}
Everything else is as in `scene.toml`. Numbers are drawn by counting, from seed, sample and the value's name: a
sample is the same whatever the count, the shards and the threads.

## What was thrown away

Kept is what has at least {} of each camera's pixels lit, and {} of each projector's picture seen.

{}
## What a sample holds

`sample.json` (`sample.schema.json` says what is in it: drawn values, sensors, effects, matrices), the scene
(`scene.toml`, self-contained), the pictures, `truth/*.npy` (projector u and v, depth, normal, object),
`mask/*.png` (255 where both see: u and v are told in shadow and beyond the picture, too), `correspondences/*.npy`. In `tars/` file `PATH` of sample `KEY` is `KEY.PATH` with dots for slashes.

`checksums.txt` has a line per sample: `(cd samples/BLOCK/KEY && find . -type f -printf '%P\n' | LC_ALL=C sort | xargs sha256sum | sha256sum)`.

## What it cost

{})",
      spec.settings.name,
      spec.settings.description.empty() ? "A Laterna data set." : spec.settings.description, totals.samples,
      seed, totals.files, 1e-9 * double(totals.bytes), spec.settings.licence, distribution_rows(spec),
      spec.reject.least_lit, spec.reject.least_projector, rejection_rows(totals), cost_lines(totals, costs));
}

}  // namespace laterna
