#include "apps/lab/dataset/distribution.h"

#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace laterna {

namespace {

using Json = nlohmann::json;

constexpr std::array kinds{"uniform", "log_uniform", "normal", "whole", "choice", "orbit"};

const std::string& kind_of(const Distribution& d) { return d.begin().key(); }
const Json& value_of(const Distribution& d) { return d.begin().value(); }

bool is_row(const Json& json) {
  return json.is_array() && !json.empty() &&
         std::all_of(json.begin(), json.end(), [](const Json& e) { return e.is_number(); });
}

[[noreturn]] void fail(const std::string& place, const Distribution& d, const char* expected) {
  throw InputError(fmt::format("{}: {} is {}, expected {}", place, kind_of(d), value_of(d).dump(), expected));
}

// The difference of the ends must be a number, too.
bool in_order(const Json& low, const Json& high, double above) {
  const double a = low.get<double>(), b = high.get<double>();
  return a <= b && a > above && std::isfinite(b - a);
}

bool are_ends(const Json& ends, double above = -INFINITY) {
  if (!ends.is_array() || ends.size() != 2) return false;
  if (is_row(ends)) return in_order(ends[0], ends[1], above);
  if (!is_row(ends[0]) || !is_row(ends[1]) || ends[0].size() != ends[1].size()) return false;
  for (std::size_t i = 0; i < ends[0].size(); ++i)
    if (!in_order(ends[0][i], ends[1][i], above)) return false;
  return true;
}

// At least one in some thousand of the draws must lie inside.
bool is_bell(const Json& v) {
  if (!is_row(v) || v.size() != 4 || v[1].get<double>() <= 0 || !in_order(v[2], v[3], -INFINITY))
    return false;
  const auto share_below = [&](const Json& x) {
    return 0.5 * std::erfc((v[0].get<double>() - x.get<double>()) / v[1].get<double>() / std::numbers::sqrt2);
  };
  return share_below(v[3]) - share_below(v[2]) > 1e-3;
}

bool are_whole_ends(const Json& v) {
  return v.is_array() && v.size() == 2 && v[0].is_number_integer() && v[1].is_number_integer() &&
         in_order(v[0], v[1], -INFINITY) && v[1].get<double>() - v[0].get<double>() < 0x1p62;
}

bool is_orbit(const Json& v) {
  if (!v.is_object() || v.size() != 4 || !v.contains("around") || !is_row(v["around"]) ||
      v["around"].size() != 3)
    return false;
  const auto ends = [&](const char* key, double above) {
    return v.contains(key) && is_row(v[key]) && are_ends(v[key], above);
  };
  return ends("distance", 0) && ends("azimuth_deg", -INFINITY) && ends("elevation_deg", -INFINITY);
}

double between(const Json& low, const Json& high, double share) {
  const double a = low.get<double>(), b = high.get<double>();
  return std::clamp(a + (b - a) * share, a, b);
}

double between_logs(const Json& low, const Json& high, double share) {
  const double a = low.get<double>(), b = high.get<double>();
  return std::clamp(a * std::pow(b / a, share), a, b);
}

template <class Between>
Json draw_between(const Json& ends, RandomStream& stream, const Between& of) {
  if (is_row(ends)) return of(ends[0], ends[1], stream.unit());
  Json row = Json::array();
  for (std::size_t i = 0; i < ends[0].size(); ++i) row.push_back(of(ends[0][i], ends[1][i], stream.unit()));
  return row;
}

double draw_bell(const Json& v, RandomStream& stream) {
  for (;;) {
    const double x = v[0].get<double>() + v[1].get<double>() * stream.normal();
    if (x >= v[2].get<double>() && x <= v[3].get<double>()) return x;
  }
}

Json orbit_point(const Json& v, double distance_share, double azimuth_share, double elevation_share) {
  constexpr double rad = std::numbers::pi / 180;
  const auto at = [&](const char* key, double share) { return between(v[key][0], v[key][1], share); };
  const double d = at("distance", distance_share), a = at("azimuth_deg", azimuth_share) * rad,
               e = at("elevation_deg", elevation_share) * rad;
  const std::array<double, 3> offset{d * std::cos(e) * std::cos(a), d * std::cos(e) * std::sin(a),
                                     d * std::sin(e)};
  Json point = Json::array();
  for (std::size_t i = 0; i < 3; ++i) point.push_back(v["around"][i].get<double>() + offset[i]);
  return point;
}

}  // namespace

bool is_distribution(const Json& object) {
  return object.is_object() && object.size() == 1 &&
         std::find(kinds.begin(), kinds.end(), object.begin().key()) != kinds.end();
}

void check_distribution(const Distribution& d, const std::string& place) {
  if (!is_distribution(d))
    throw InputError(fmt::format("{}: found {}, expected one of {}, as {{ uniform = [30, 60] }}", place,
                                 d.dump(), fmt::join(kinds, ", ")));
  const std::string& kind = kind_of(d);
  const Json& v = value_of(d);
  if (kind == "uniform" && !are_ends(v)) fail(place, d, "[low, high], two numbers or two rows of them");
  if (kind == "log_uniform" && !are_ends(v, 0)) fail(place, d, "[low, high], both above 0");
  if (kind == "normal" && !is_bell(v))
    fail(place, d, "[mean, sigma, low, high], sigma above 0, with some of the bell between low and high");
  if (kind == "whole" && !are_whole_ends(v)) fail(place, d, "[low, high], two whole numbers");
  if (kind == "choice" && (!v.is_array() || v.empty())) fail(place, d, "a list of what to choose from");
  if (kind == "orbit" && !is_orbit(v))
    fail(place, d, "around = [x, y, z] with distance, azimuth_deg and elevation_deg = [low, high]");
}

Json draw(const Distribution& d, RandomStream& stream) {
  const std::string& kind = kind_of(d);
  const Json& v = value_of(d);
  if (kind == "uniform") return draw_between(v, stream, between);
  if (kind == "log_uniform") return draw_between(v, stream, between_logs);
  if (kind == "normal") return draw_bell(v, stream);
  if (kind == "choice") return v[stream.below(v.size())];
  if (kind == "whole") {
    const auto low = v[0].get<std::int64_t>(), high = v[1].get<std::int64_t>();
    return low + std::int64_t(stream.below(std::uint64_t(high - low) + 1));
  }
  const double distance = stream.unit(), azimuth = stream.unit(), elevation = stream.unit();
  return orbit_point(v, distance, azimuth, elevation);
}

std::vector<Json> ends_of(const Distribution& d) {
  const std::string& kind = kind_of(d);
  const Json& v = value_of(d);
  if (kind == "choice") return v.get<std::vector<Json>>();
  if (kind == "normal") return {v[2], v[3]};
  if (kind == "orbit") return {orbit_point(v, 0, 0, 0), orbit_point(v, 1, 1, 1)};
  return {v[0], v[1]};
}

std::string distribution_text(const Distribution& d) {
  const std::string& kind = kind_of(d);
  const Json& v = value_of(d);
  if (kind == "normal")
    return fmt::format("normal, mean {}, sigma {}, from {} to {}", v[0].dump(), v[1].dump(), v[2].dump(),
                       v[3].dump());
  if (kind == "choice") return fmt::format("one of {}, all alike", v.dump());
  if (kind == "orbit")
    return fmt::format("about {}: distance {}, azimuth {} deg, elevation {} deg, each uniform",
                       v["around"].dump(), v["distance"].dump(), v["azimuth_deg"].dump(),
                       v["elevation_deg"].dump());
  return fmt::format("{} {} to {}",
                     kind == "whole"     ? "a whole number,"
                     : kind == "uniform" ? "uniform"
                                         : "uniform in the logarithm,",
                     v[0].dump(), v[1].dump());
}

}  // namespace laterna
