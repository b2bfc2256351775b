#include "apps/laterna/command.h"

#include "apps/lab/known_intrinsics.h"
#include "apps/lab/selfcal_report.h"
#include "apps/lab/track_folders.h"
#include "sim/error.h"
#include "sim/safe_write.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <map>

namespace laterna {

namespace {

struct Words {
  std::vector<std::string> inputs, sizes, known, assume, centers, lenses;
  std::string length, out, table;
  TrackFolderOptions folders;
  SelfCalibrationOptions options;
};

// NAME=VALUE, each name once.
std::map<std::string, std::string> by_name(const std::vector<std::string>& words, const char* option) {
  std::map<std::string, std::string> result;
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == word.size() ||
        !result.emplace(word.substr(0, equals), word.substr(equals + 1)).second)
      throw InputError(fmt::format("{}: found \"{}\", expected NAME=VALUE, each name once", option, word));
  }
  return result;
}

std::string take(std::map<std::string, std::string>& words, const std::string& name) {
  const auto node = words.extract(name);
  return node ? node.mapped() : std::string();
}

// What --known NAME=FILE says, in the numbers' place; FILE.cameramodel, or what `laterna calibrate -o` wrote.
bool known_by_file(TrackDevice& device, const std::string& file) {
  if (file.empty() || std::count(file.begin(), file.end(), ',') == 3) return false;
  const KnownByName known = read_known_intrinsics({device.name + "=" + file});
  const KnownIntrinsics& k = known.at(device.name);
  const glm::ivec2 told = device.intrinsics.size;
  if (told.x > 0 && told != k.intrinsics.size)
    throw InputError(fmt::format("{}: {} is of {}x{} pixels, expected {}x{}", device.name, file,
                                 k.intrinsics.size.x, k.intrinsics.size.y, told.x, told.y));
  device = {device.name, k.intrinsics, false, false, false, k.lens};
  return true;
}

// NAME=WORD, or WORD for all devices whose intrinsics are not known.
void add_lenses(Tracks& tracks, const std::vector<std::string>& words) {
  std::vector<std::string> named, of_all;
  for (const std::string& word : words) (word.find('=') == word.npos ? of_all : named).push_back(word);
  if (of_all.size() > 1)
    throw InputError(fmt::format("--lens: found \"{}\" after \"{}\", expected one word for all devices",
                                 of_all[1], of_all[0]));
  auto by_device = by_name(named, "--lens");
  for (TrackDevice& d : tracks.devices) {
    std::string word = take(by_device, d.name);
    if (!word.empty() && d.lens_known())
      throw InputError(fmt::format("--lens {}={}: its lens is known already, from --known", d.name, word));
    if (word.empty() && !of_all.empty() && d.focal) word = of_all[0];
    if (!word.empty()) set_lens_word(d, word);
  }
  if (!by_device.empty())
    throw InputError(fmt::format("--lens: there is no device \"{}\"", by_device.begin()->first));
  if (!of_all.empty() && std::none_of(tracks.devices.begin(), tracks.devices.end(),
                                      [](const TrackDevice& d) { return d.focal; }))
    throw InputError(
        fmt::format("--lens {}: all intrinsics are known, expected NAME={}", of_all[0], of_all[0]));
}

void describe_devices(Tracks& tracks, const Words& words) {
  auto sizes = by_name(words.sizes, "--size"), known = by_name(words.known, "--known"),
       assume = by_name(words.assume, "--assume"), centers = by_name(words.centers, "--center");
  for (TrackDevice& d : tracks.devices) {
    glm::ivec2 size = d.intrinsics.size;
    const std::string told = take(sizes, d.name);
    if (!told.empty()) {
      const auto parsed = parse_size(told, "--size");
      size = {parsed[0], parsed[1]};
    }
    d.intrinsics.size = size;
    const std::string of_known = take(known, d.name);
    if (known_by_file(d, of_known)) {
      if (assume.contains(d.name) || centers.contains(d.name))
        throw InputError(
            fmt::format("{}: --known {} beside --assume or --center, expected it alone", d.name, of_known));
      continue;
    }
    if (size.x == 0) throw InputError(fmt::format("--size {}=WIDTHxHEIGHT is missing", d.name));
    d = device_in_words(d.name, size, of_known, take(assume, d.name), take(centers, d.name));
  }
  for (const auto& [option, rest] : {std::pair("--size", &sizes), std::pair("--known", &known),
                                     std::pair("--assume", &assume), std::pair("--center", &centers)})
    if (!rest->empty())
      throw InputError(fmt::format("{}: there is no device \"{}\"", option, rest->begin()->first));
  add_lenses(tracks, words.lenses);
}

// POINT_A,POINT_B,METRES.
KnownLength length_of(const Tracks& tracks, const std::string& text) {
  const std::size_t second = text.rfind(','), first = second == 0 ? second : text.rfind(',', second - 1);
  const auto fail = [&] {
    return InputError(fmt::format(
        "--length: found \"{}\", expected POINT_A,POINT_B,METRES with two points of the table", text));
  };
  if (second == std::string::npos || first == std::string::npos || first >= second) throw fail();
  const auto point = [&](const std::string& name) {
    const auto at = std::find(tracks.point_names.begin(), tracks.point_names.end(), name);
    if (at == tracks.point_names.end()) throw fail();
    return int(at - tracks.point_names.begin());
  };
  KnownLength length{point(text.substr(0, first)), point(text.substr(first + 1, second - first - 1)), 0};
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data() + second + 1, end, length.metres);
  if (error != std::errc() || at != end) throw fail();
  return length;
}

Tracks tracks_of(const Words& words) {
  if (std::filesystem::is_directory(words.inputs.front()))
    return tracks_of_folders({words.inputs.begin(), words.inputs.end()}, words.folders);
  if (words.inputs.size() > 1)
    throw InputError(fmt::format("{}: found {} inputs, expected one FILE.csv or capture folders",
                                 words.inputs.front(), words.inputs.size()));
  return read_tracks(words.inputs.front());
}

int run(const Words& words, const Common& common) {
  Tracks tracks = tracks_of(words);
  if (!words.table.empty()) write_file(words.table, tracks_text(tracks));
  describe_devices(tracks, words);
  SelfCalibrationOptions options = words.options;
  if (!words.length.empty()) options.length = length_of(tracks, words.length);
  const SelfCalibration calibration = self_calibrate(tracks, options);
  const std::string text = selfcal_json(calibration).dump(2) + "\n";
  if (!words.out.empty()) write_file(words.out, text);
  fmt::print("{}", common.json ? text : selfcal_text(calibration));
  if (!words.out.empty() && !common.json) fmt::print("open {}\n", words.out);
  if (calibration.status == Status::refused) return exit_refused;
  return calibration.status == Status::weak ? exit_weak : exit_ok;
}

}  // namespace

void add_selfcal(CLI::App& app, Common& common) {
  auto words = std::make_shared<Words>();
  CLI::App* command = add_command(
      app, "selfcal",
      "laterna selfcal FILE.csv --size camera=1280x1024 --size projector=1024x768 \\\n"
      "           --known camera=1500,1500,640,512 --assume projector=focal+center",
      "Devices and their placements from correspondences alone, up to scale. FILE.csv has the columns\n"
      "point,device,station,x,y[,sigma_px]; a station is one placement of one device. Or capture folders, "
      "one\n"
      "for each place of the projector, with camera and scene at rest.");
  command->add_option("INPUT", words->inputs, "FILE.csv, or capture folders")->required();
  command->add_option("--size", words->sizes, "NAME=WIDTHxHEIGHT, for each device of a FILE.csv");
  command->add_option(
      "--known", words->known,
      "NAME=fx,fy,cx,cy, or NAME=FILE with a lens (mrcal's .cameramodel, or what calibrate -o "
      "wrote): a device whose intrinsics are held");
  command->add_option(
      "--assume", words->assume,
      "NAME=focal, focal+center, focal+aspect or focal+aspect+center: what is solved for; the "
      "rest is square pixels and the principal point in the middle");
  command->add_option("--center", words->centers,
                      "NAME=cx,cy: the principal point elsewhere than in the middle");
  command->add_option(
      "--lens", words->lenses,
      "NAME=pinhole, k1, opencv4, opencv5, opencv8, terms joined by +, or auto: distortion that "
      "is solved for; without NAME= of all devices but known ones. auto adds a term only where "
      "points that were left out are forecast better (default: pinhole)");
  command->add_option("--length", words->length, "POINT_A,POINT_B,METRES: a known distance gives the scale");
  command->add_option("--tolerance-px", words->options.tolerance_px, "Predicted error above it is weak")
      ->capture_default_str();
  command
      ->add_option("--stride", words->folders.stride, "For folders: every so many camera pixels is a point")
      ->capture_default_str();
  command->add_flag("--scene-moved", words->folders.scene_moved,
                    "For folders: the scene moved between them, the devices did not");
  command->add_option("--table", words->table, "Writes the correspondences as FILE.csv");
  command->add_option("-o,--output", words->out, "File for the result (JSON; default: none written)");
  command->callback([words, &common] {
    check_output(words->out);
    check_output(words->table);
    common.exit_code = run(*words, common);
  });
}

}  // namespace laterna
