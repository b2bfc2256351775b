#include "apps/lab/track_folders.h"

#include "apps/lab/decode_folder.h"
#include "sim/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace laterna {

namespace {

int device_named(Tracks& tracks, const std::string& name, glm::ivec2 size) {
  for (std::size_t d = 0; d < tracks.devices.size(); ++d) {
    if (tracks.devices[d].name != name) continue;
    const glm::ivec2 before = tracks.devices[d].intrinsics.size;
    if (before != size)
      throw InputError(fmt::format("{}: {}x{} pixels in one folder and {}x{} in another, expected the same",
                                   name, before.x, before.y, size.x, size.y));
    return int(d);
  }
  tracks.devices.push_back({name, {size, 0, 0, 0, 0}, false, false, false});
  return int(tracks.devices.size()) - 1;
}

int station_named(Tracks& tracks, int device, const std::string& name) {
  for (int s = 0; s < tracks.station_count(); ++s)
    if (tracks.stations[s].device == device && tracks.stations[s].name == name) return s;
  tracks.stations.push_back({device, name});
  return tracks.station_count() - 1;
}

// Points by camera and pixel (and scene); the camera's sighting stands beside the first of a projector.
struct PointBook {
  std::map<std::string, int> known;

  void add(Tracks& tracks, const DecodedMap& map, int camera, int projector, const std::string& scene,
           const TrackFolderOptions& options) {
    for (int y = options.stride / 2; y < map.height; y += options.stride)
      for (int x = options.stride / 2; x < map.width; x += options.stride) {
        const std::size_t i = std::size_t(y) * std::size_t(map.width) + std::size_t(x);
        if (!map.valid.values[i]) continue;
        const std::string name = fmt::format("{}{}:{}:{}", scene, camera, x, y);
        const auto [at, added] = known.emplace(name, tracks.point_count());
        if (added) {
          tracks.point_names.push_back(name);
          tracks.sightings.push_back({at->second, camera, {x, y}, options.camera_sigma_px});
        }
        tracks.sightings.push_back({at->second,
                                    projector,
                                    {map.u_px.values[i], map.v_px.values[i]},
                                    std::max(0.01, double(map.sigma_px.values[i]))});
      }
  }
};

}  // namespace

Tracks tracks_of_folders(const std::vector<std::filesystem::path>& folders,
                         const TrackFolderOptions& options) {
  if (options.stride < 1)
    throw InputError(fmt::format("stride: found {}, expected 1 or more", options.stride));
  Tracks tracks;
  tracks.has_sigma = true;
  PointBook book;
  for (std::size_t f = 0; f < folders.size(); ++f) {
    for (const CaptureSequence& sequence : manifest_or_pictures(folders[f], {}).sequences) {
      const DecodedSequence decoded = decode_sequence(folders[f], sequence, {});
      const int camera = device_named(tracks, sequence.camera, {decoded.map.width, decoded.map.height});
      const int projector = device_named(tracks, sequence.projector, sequence.projector_size);
      const int seen_from = station_named(tracks, camera, "0");
      const int lit_from = station_named(tracks, projector, options.scene_moved ? "0" : fmt::format("{}", f));
      book.add(tracks, decoded.map, seen_from, lit_from, options.scene_moved ? fmt::format("{}:", f) : "",
               options);
    }
  }
  std::stable_sort(tracks.sightings.begin(), tracks.sightings.end(), [](const auto& a, const auto& b) {
    return std::pair(a.point, a.station) < std::pair(b.point, b.station);
  });
  return tracks;
}

}  // namespace laterna
