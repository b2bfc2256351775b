#include "calib/selfcal/tracks.h"

#include "calib/boards/rig.h"

#include "calib/csv.h"
#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

namespace laterna {

namespace {

enum Column { point, device, station, x, y, sigma_px };

template <class Key>
int index_of(std::map<Key, int>& known, const Key& key, int next) {
  return known.emplace(key, next).first->second;
}

// Devices, stations and points by their labels, in the order in which they appear.
struct Labels {
  std::map<std::string, int> devices, points;
  std::map<std::pair<int, std::string>, int> stations;

  void name(Tracks& tracks, const CsvLine& line, TrackSighting& s) {
    const std::string device_name = line.text(device), station_name = line.text(station);
    const int d = index_of(devices, device_name, int(tracks.devices.size()));
    if (d == int(tracks.devices.size())) tracks.devices.push_back({device_name, {}, false, false, false});
    s.station = index_of(stations, std::pair(d, station_name), tracks.station_count());
    if (s.station == tracks.station_count()) tracks.stations.push_back({d, station_name});
    const std::string point_name = line.text(point);
    s.point = index_of(points, point_name, tracks.point_count());
    if (s.point == tracks.point_count()) tracks.point_names.push_back(point_name);
  }
};

void sort_sightings(Tracks& tracks) {
  std::stable_sort(tracks.sightings.begin(), tracks.sightings.end(), [](const auto& a, const auto& b) {
    return std::pair(a.point, a.station) < std::pair(b.point, b.station);
  });
}

// Numbers joined by commas; none where there are more or fewer, or one is not finite.
template <std::size_t n>
std::optional<std::array<double, n>> numbers(std::string_view text) {
  const auto parts = split_trimmed(text, ',');
  if (parts.size() != n) return std::nullopt;
  std::array<double, n> values{};
  for (std::size_t i = 0; i < n; ++i) {
    const char* end = parts[i].data() + parts[i].size();
    const auto [at, error] = std::from_chars(parts[i].data(), end, values[i]);
    if (error != std::errc() || at != end || !std::isfinite(values[i])) return std::nullopt;
  }
  return values;
}

}  // namespace

Tracks parse_tracks(std::string_view text, const std::string& file_name) {
  std::vector<std::string> columns;
  const auto lines =
      csv_lines(text, file_name, {"point", "device", "station", "x", "y"}, {"sigma_px"}, columns);
  if (lines.empty())
    throw InputError(fmt::format("{}: line 2: found nothing, expected lines of sightings", file_name));
  Tracks tracks;
  Labels labels;
  std::map<std::pair<int, int>, bool> seen;
  for (const CsvLine& line : lines) {
    TrackSighting s;
    labels.name(tracks, line, s);
    s.pixel = {line.number(x), line.number(y)};
    if (!line.cells[sigma_px].empty()) {
      s.sigma_px = line.number(sigma_px);
      if (!(s.sigma_px > 0)) line.refuse(sigma_px, "a positive number");
    }
    if (tracks.sightings.empty()) tracks.has_sigma = !line.cells[sigma_px].empty();
    if (tracks.has_sigma == line.cells[sigma_px].empty())
      line.refuse(sigma_px, "sigmas in all lines or in none");
    if (!seen.emplace(std::pair(s.point, s.station), true).second) {
      throw InputError(fmt::format("{}: {} has point \"{}\" twice, expected it once", line.place,
                                   tracks.station_name(s.station), tracks.point_names[s.point]));
    }
    tracks.sightings.push_back(s);
  }
  sort_sightings(tracks);
  return tracks;
}

Tracks read_tracks(const std::filesystem::path& path) {
  return parse_tracks(read_text(path, std::size_t{256} << 20), path.string());
}

std::string tracks_text(const Tracks& tracks) {
  std::string text = tracks.has_sigma ? "point,device,station,x,y,sigma_px\n" : "point,device,station,x,y\n";
  for (const TrackSighting& s : tracks.sightings) {
    const Station& at = tracks.stations[s.station];
    text += fmt::format("{},{},{},{},{}", tracks.point_names[s.point], tracks.devices[at.device].name,
                        at.name, s.pixel.x, s.pixel.y);
    text += tracks.has_sigma ? fmt::format(",{}\n", s.sigma_px) : "\n";
  }
  return text;
}

void validate(const Tracks& tracks) {
  for (const TrackDevice& d : tracks.devices) {
    Intrinsics k = d.intrinsics;
    if (d.focal) k.fx = k.fy = 1;
    validate(k, d.name.c_str());
    const LensProjection checks_the_lens(k, d.lens);
    if (!d.lens_free.empty() && d.lens_free.size() != d.lens.parameters.size())
      throw InputError(fmt::format("{}: {} flags of free lens parameters, expected {}", d.name,
                                   d.lens_free.size(), d.lens.parameters.size()));
  }
  for (const Station& s : tracks.stations)
    if (s.device < 0 || s.device >= int(tracks.devices.size()))
      throw InputError(
          fmt::format("station {}: device {}, expected one of {}", s.name, s.device, tracks.devices.size()));
  for (std::size_t i = 0; i < tracks.sightings.size(); ++i) {
    const TrackSighting& s = tracks.sightings[i];
    if (s.point < 0 || s.point >= tracks.point_count() || s.station < 0 ||
        s.station >= tracks.station_count() || !std::isfinite(s.pixel.x) || !std::isfinite(s.pixel.y) ||
        !(s.sigma_px > 0 && std::isfinite(s.sigma_px)))
      throw InputError(
          fmt::format("sighting {}: point {}, station {}, pixel ({}, {}), sigma {}, expected "
                      "known ones and finite numbers",
                      i, s.point, s.station, s.pixel.x, s.pixel.y, s.sigma_px));
    if (i > 0 && std::pair(tracks.sightings[i - 1].point, tracks.sightings[i - 1].station) >=
                     std::pair(s.point, s.station))
      throw InputError(fmt::format("sighting {}: expected each once, sorted by point and station", i));
  }
}

TrackDevice device_in_words(const std::string& name, glm::ivec2 size, const std::string& known,
                            const std::string& assume, const std::string& center) {
  if (known.empty() == assume.empty())
    throw InputError(fmt::format("{}: found {} of --known and --assume, expected one of them", name,
                                 known.empty() ? "none" : "both"));
  TrackDevice d{name, {size, 0, 0, (size.x - 1) / 2.0, (size.y - 1) / 2.0}, false, false, false};
  if (!known.empty()) {
    const auto k = numbers<4>(known);
    if (!k || !center.empty())
      throw InputError(fmt::format("{}: known is \"{}\"{}, expected fx,fy,cx,cy alone", name, known,
                                   center.empty() ? "" : " beside a center"));
    d.intrinsics = {size, (*k)[0], (*k)[1], (*k)[2], (*k)[3]};
    validate(d.intrinsics, name.c_str());
    return d;
  }
  for (const std::string_view word : split_trimmed(assume, '+')) {
    bool* free = word == "focal"    ? &d.focal
                 : word == "aspect" ? &d.aspect
                 : word == "center" ? &d.center
                                    : nullptr;
    if (!free || *free || !assume.starts_with("focal"))
      throw InputError(
          fmt::format("{}: assumed is \"{}\", expected focal, focal+center, focal+aspect or "
                      "focal+aspect+center",
                      name, assume));
    *free = true;
  }
  if (!center.empty()) {
    const auto c = numbers<2>(center);
    if (!c) throw InputError(fmt::format("{}: center is \"{}\", expected cx,cy", name, center));
    d.intrinsics.cx = (*c)[0], d.intrinsics.cy = (*c)[1];
  }
  return d;
}

void set_lens_word(TrackDevice& device, const std::string& word) {
  device.lens_climbs = word == "auto";
  if (device.lens_climbs) return;
  try {
    const std::vector<std::string> terms = lens_terms(word);
    if (are_splined(terms))
      throw InputError("a splined lens is for boards and known scenes, expected another lens");
    const DeviceModel model = model_of_terms(terms);
    device.lens = {model.lens_model, std::vector<double>(model.lens_free.size(), 0.0)};
    device.lens_free = model.lens_free;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", device.name, error.what()));
  }
}

}  // namespace laterna
