#include "apps/lab/dataset/cost.h"

#include "sim/parallel.h"

#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <fstream>
#include <map>
#include <string>

namespace laterna {

namespace {

double seconds_of(const timeval& time) { return double(time.tv_sec) + 1e-6 * double(time.tv_usec); }

double cpu_now_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

double wall_now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

CostClock::CostClock() : cpu_s_(cpu_now_s()), wall_s_(wall_now_s()) {}

RunCost CostClock::cost(std::uint64_t samples) const {
  return {samples, cpu_now_s() - cpu_s_, wall_now_s() - wall_s_, thread_count()};
}

void keep_cost(const std::filesystem::path& run_folder, const RunCost& cost) {
  if (cost.samples == 0) return;
  const nlohmann::json line{
      {"samples", cost.samples}, {"cpu_s", cost.cpu_s}, {"wall_s", cost.wall_s}, {"threads", cost.threads}};
  std::ofstream(run_folder / "cost.jsonl", std::ios::app) << line.dump() + "\n";
}

namespace {

void add(RunCost& sum, const RunCost& cost) {
  sum.samples += cost.samples, sum.cpu_s += cost.cpu_s, sum.wall_s += cost.wall_s;
}

}  // namespace

std::vector<RunCost> costs_by_threads(const DatasetFolder& folder) {
  std::map<int, RunCost> sums;
  std::error_code failed;
  for (const auto& run : std::filesystem::directory_iterator(folder.root / "runs", failed)) {
    std::ifstream file(run.path() / "cost.jsonl");
    for (std::string line; std::getline(file, line);) {
      const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
      if (!json.is_object()) continue;  // cut short
      const int threads = json.value("threads", 0);
      RunCost& sum = sums[threads];
      add(sum,
          {json.value("samples", std::uint64_t{0}), json.value("cpu_s", 0.0), json.value("wall_s", 0.0)});
      sum.threads = threads;
    }
  }
  std::vector<RunCost> rising;
  for (const auto& [threads, sum] : sums) rising.push_back(sum);
  return rising;
}

RunCost sum_of(const std::vector<RunCost>& costs) {
  RunCost sum;
  for (const RunCost& cost : costs) add(sum, cost);
  if (costs.size() == 1) sum.threads = costs[0].threads;
  return sum;
}

}  // namespace laterna
