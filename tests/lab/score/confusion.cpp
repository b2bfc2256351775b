#include "tests/lab/score/confusion.h"

#include "apps/lab/score/suspects.h"
#include "calib/solve.h"
#include "tests/lab/score/foreign_files.h"
#include "tests/lab/score/planted.h"
#include "tests/testing.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <cmath>
#include <ostream>
#include <set>

namespace laterna::testing {

namespace {

class Bench {
 public:
  Bench(std::mt19937_64& random, const ScratchFolder& scratch)
      : rig_(random_rig(random)), scratch_(scratch), random_(random) {}

  const CalibratedRig& rig() const { return rig_; }

  Verdict verdict(const std::string& planted, const std::string& how, const Rig& result) {
    Verdict v{planted, how, "", {}, 0, rig_.bound_px};
    const RigReadOptions options{"", 1, rig_.camera.intrinsics.size, rig_.projector.intrinsics.size};
    const auto [read, format] = told_by_a_file(result, one_of(random_, 10), scratch_.path(), options);
    v.format = format;
    const ScoreRig told{read.rig.cameras.at(0), read.rig.projectors.at(0)};
    const Probe probe = make_probe({rig_.camera, rig_.projector}, {true, false}, rig_.seen.world_points);
    v.error_px = std::sqrt(squared_error_px2(result_pixels(told, probe), probe));
    v.shows = v.error_px > std::max(0.1, 5 * rig_.bound_px);
    if (!v.shows) return v;  // ok: nobody is asked
    for (const Suspect& s : geometric_suspects(told, probe, rig_.bound_px)) v.named.push_back(s.name);
    return v;
  }

 private:
  CalibratedRig rig_;
  const ScratchFolder& scratch_;
  std::mt19937_64& random_;
};

Rig noisier(const CalibratedRig& rig, double times, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  for (;;) {
    Correspondences noisy = rig.seen;
    for (std::size_t i = 0; i < noisy.projector_pixels.size(); ++i)
      noisy.projector_pixels[i] += times * noisy.sigma_px[i] * glm::dvec2(normal(random), normal(random));
    SolveOptions options;
    options.lens_model = rig.projector.lens.model;
    const SolveResult solved = solve(noisy, rig.projector.intrinsics.size, options);
    Rig result = right_result(rig, false);
    if (solved.status == Status::refused) continue;
    result.projectors[0] = solved.estimate;
    result.projectors[0].name = rig.projector.name;
    return result;
  }
}

Rig generally_wrong(const CalibratedRig& rig, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double size = std::exp(uniform(random, std::log(0.002), std::log(0.02)));
  const auto by = [&] { return size * normal(random); };
  Rig result = right_result(rig, false);
  Device& d = result.projectors[0];
  Intrinsics& k = d.intrinsics;
  k.fx *= 1 + by(), k.fy *= 1 + by(), k.cx += k.size.x * by(), k.cy += k.size.y * by();
  const double distance = glm::length(apply(d.device_from_world, rig.seen.world_points[0]));
  const Rigid moved =
      rigid_from_rotation_vector(glm::dvec3(by(), by(), by()), distance * glm::dvec3(by(), by(), by()));
  d.device_from_world = compose(moved, d.device_from_world);
  return result;
}

}  // namespace

std::vector<Verdict> planted_verdicts(int rigs, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const ScratchFolder scratch;
  const auto mistakes = planted_mistakes();
  std::vector<Verdict> verdicts;
  for (int i = 0; i < rigs; ++i) {
    Bench bench(random, scratch);
    const auto add = [&](const std::string& planted, const std::string& how, const Rig& result) {
      verdicts.push_back(bench.verdict(planted, how, result));
    };
    for (const bool in_camera : {false, true}) add("right", "", right_result(bench.rig(), in_camera));
    for (const double times : {1.0, 3.0, 10.0})
      add("noisy", fmt::format("{}", times), noisier(bench.rig(), times, random));
    add("generally wrong", "", generally_wrong(bench.rig(), random));
    auto planted = mistakes;
    for (int pair = 0; pair < 6; ++pair) planted.push_back(two_mistakes(random));
    for (const Planted& mistake : planted) {
      Rig result = right_result(bench.rig(), one_of(random, 2) == 0);
      mistake.make(result, bench.rig(), random);
      add(mistake.suspect, mistake.how, result);
    }
  }
  return verdicts;
}

namespace {

// What was said of a verdict: the first suspect, or for two mistakes whether both stand in front.
std::string said(const Verdict& v) {
  if (v.named.empty()) return v.shows ? "nobody" : "unseen";
  const std::size_t plus = v.planted.find(" + ");
  if (plus == std::string::npos) return (v.shows ? "" : "unseen, but ") + v.named[0];
  const std::set<std::string> both{v.planted.substr(0, plus), v.planted.substr(plus + 3)};
  if (v.named.size() > 1 && both == std::set<std::string>(v.named.begin(), v.named.begin() + 2))
    return "both";
  return both.contains(v.named[0]) ? "one of them" : v.named[0];
}

bool is_pair(const Verdict& v) { return v.planted.find(" + ") != std::string::npos; }

}  // namespace

std::map<std::string, double> named_rates(const std::vector<Verdict>& verdicts) {
  std::map<std::string, std::pair<int, int>> counts;
  for (const Verdict& v : verdicts) {
    if (!v.shows || v.planted == "right" || v.planted == "noisy" || v.planted == "generally wrong") continue;
    auto& [named, all] = counts[is_pair(v) ? "two mistakes" : v.planted];
    named += said(v) == (is_pair(v) ? "both" : v.planted);
    ++all;
  }
  std::map<std::string, double> rates;
  for (const auto& [planted, count] : counts) rates[planted] = count.first / double(count.second);
  return rates;
}

int falsely_named(const std::vector<Verdict>& verdicts) {
  int named = 0;
  for (const Verdict& v : verdicts)
    named += !v.named.empty() && (v.planted == "right" || (v.planted == "noisy" && v.how != "10") ||
                                  (v.planted == "gamma" && !v.shows));
  return named;
}

void print_confusion(const std::vector<Verdict>& verdicts, std::ostream& out) {
  std::map<std::string, std::map<std::string, int>> table;
  for (const Verdict& v : verdicts) {
    ++table[is_pair(v) ? "two mistakes" : v.how.empty() ? v.planted : v.planted + " / " + v.how][said(v)];
  }
  for (const auto& [row, counts] : table) {
    out << fmt::format("{:<45}", row);
    for (const auto& [name, count] : counts) out << fmt::format(" {} {};", name, count);
    out << '\n';
  }
  std::map<std::string, int> of_format;
  for (const Verdict& v : verdicts) ++of_format[v.format];
  for (const auto& [name, count] : of_format) out << name << " " << count << ", ";
  out << '\n';
}

}  // namespace laterna::testing
