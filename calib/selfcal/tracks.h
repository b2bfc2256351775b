// What self-calibration starts from: pixels of the same points in several placements of a few devices.
#pragma once

#include "sim/intrinsics.h"
#include "sim/lens.h"

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace laterna {

/// A camera or a projector: u = fx·x/z + cx, v = fy·y/z + cy, or a lens of sim/lens.h. What is not free keeps
/// its value.
struct TrackDevice {
  std::string name;
  Intrinsics intrinsics;  ///< held values; of what is free, only the principal point counts, as a start
  bool focal = false;     ///< the focal length is solved for: fx = fy unless `aspect`
  bool aspect = false;    ///< fx and fy are two numbers
  bool center = false;    ///< cx and cy are solved for
  Lens lens = {};         ///< held parameters; of what is free, a start
  std::vector<bool> lens_free = {};  ///< one per lens parameter: it is solved for; empty: none is
  bool lens_climbs = false;          ///< terms are added while they forecast better (track_ladder.h)

  /// The lens is given, not sought: its distortion can be undone before anything is solved.
  bool lens_known() const { return !is_pinhole(lens) && lens_free_count() == 0; }
  int lens_free_count() const { return int(std::count(lens_free.begin(), lens_free.end(), true)); }
  int free_count() const { return int(focal) + int(aspect) + 2 * int(center) + lens_free_count(); }
};

/// A placement of a device. A device that did not move between two pictures stands in one station.
struct Station {
  int device = 0;
  std::string name;  ///< the file's label
};

struct TrackSighting {
  int point = 0, station = 0;
  glm::dvec2 pixel{0.0};  ///< integer coordinates are pixel centres
  double sigma_px = 1;    ///< standard deviation of u and of v
};

struct Tracks {
  std::vector<TrackDevice> devices;
  std::vector<Station> stations;
  std::vector<std::string> point_names;
  std::vector<TrackSighting> sightings;  ///< sorted by point, then station
  bool has_sigma = false;                ///< the sigmas were measured; else they are to be estimated

  int station_count() const { return int(stations.size()); }
  int point_count() const { return int(point_names.size()); }
  std::string station_name(int s) const {
    return devices[stations[s].device].name + " at " + stations[s].name;
  }
};

/// Reads a table with the columns point, device, station, x, y and, at will, sigma_px, named in its first
/// line, in any order: one line for each pixel in which a device sees (or lights) a point. All three labels
/// are free text. A *station* is one placement of one device; the label belongs to its device, so a camera
/// that stays while the projector goes to three places has one station and the projector three. It is named
/// apart, rather than a number of the view, because what moved is what decides how much the data can tell.
/// A point keeps its label as long as the scene stands still; when the scene moves, its points get new ones.
///
/// Devices and stations keep the order in which they first appear; the first station's frame is the
/// reference. Devices have no size or intrinsics yet.
///
/// Throws InputError, beginning with the file and the line, for what csv_lines() refuses, an empty label, a
/// pixel that is no finite number, a sigma that is not positive, a station that has a point twice, and a
/// table without lines.
Tracks parse_tracks(std::string_view text, const std::string& file_name);

/// The same from a file of at most 256 MiB.
Tracks read_tracks(const std::filesystem::path& path);

/// The inverse of parse_tracks, sigmas included.
std::string tracks_text(const Tracks& tracks);

/// Throws InputError where a device has no valid size, a held focal length that is not positive, a lens that
/// LensProjection refuses, a number that is not finite, or an index is out of range; sightings must be sorted
/// and single.
void validate(const Tracks& tracks);

/// What a table says of a device by words. `known`: "fx,fy,cx,cy", or empty. `assume`: what is free, joined
/// by +: focal, focal+center, focal+aspect, focal+aspect+center; what is not named is assumed: square
/// pixels, the principal point in the middle of the image or at `center` ("cx,cy"). Exactly one of the two
/// must be given. Throws InputError, naming the device, for other words.
TrackDevice device_in_words(const std::string& name, glm::ivec2 size, const std::string& known,
                            const std::string& assume, const std::string& center = "");

/// What a device's lens is said to be: auto, or a word of lens_terms() (boards/rig.h), whose terms are solved
/// for. Throws InputError, naming the device, for another word.
void set_lens_word(TrackDevice& device, const std::string& word);

}  // namespace laterna
