#include "sim/formats/colmap.h"

#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

namespace laterna {

namespace {

constexpr double centre_there = 0.5;

// Lines and their words, with the place for messages.
class Lines {
 public:
  Lines(const std::string& text, std::string file) : stream_(text), file_(std::move(file)) {
    check_text(text, file_);
  }

  /// The next line, comments passed over; false at the end.
  bool next(bool skip_empty = true) {
    for (std::string line; std::getline(stream_, line);) {
      ++number_;
      words_.clear();
      std::istringstream words(line);
      for (std::string word; words >> word;) words_.push_back(word);
      if ((!words_.empty() && words_[0].starts_with('#')) || (words_.empty() && skip_empty)) continue;
      return true;
    }
    return false;
  }
  const std::vector<std::string>& words() const { return words_; }
  double number(std::size_t i) const {
    double value = 0;
    if (!read_number(words_.at(i), value)) fail(fmt::format("found \"{}\", expected a number", words_[i]));
    return value;
  }
  int whole_number(std::size_t i) const {
    const double value = number(i);
    if (!is_whole(value)) fail(fmt::format("found \"{}\", expected a whole number", words_[i]));
    return int(value);
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, number_, what));
  }

 private:
  std::istringstream stream_;
  std::string file_;
  std::vector<std::string> words_;
  int number_ = 0;
};

// A model of COLMAP's: one focal length or two, then the centre, then distortion terms.
struct Model {
  int focal_lengths;
  std::size_t terms;
};
const std::map<std::string, Model> models = {{"SIMPLE_PINHOLE", {1, 0}}, {"PINHOLE", {2, 0}},
                                             {"SIMPLE_RADIAL", {1, 1}},  {"RADIAL", {1, 2}},
                                             {"OPENCV", {2, 4}},         {"FULL_OPENCV", {2, 8}}};

Device camera_of(const Lines& line) {
  if (line.words().size() < 5) line.fail("expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS");
  const auto model = models.find(line.words()[1]);
  if (model == models.end())
    line.fail(fmt::format(
        "model {}, expected PINHOLE, SIMPLE_PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV or FULL_OPENCV",
        line.words()[1]));
  const auto [focal_lengths, terms] = model->second;
  std::vector<double> p;
  for (std::size_t i = 4; i < line.words().size(); ++i) p.push_back(line.number(i));
  const std::size_t expected = std::size_t(focal_lengths) + 2 + terms;
  if (p.size() != expected)
    line.fail(fmt::format("{} parameters of {}, expected {}", p.size(), model->first, expected));
  if (focal_lengths == 1) p.insert(p.begin(), p[0]);
  Device device;
  device.intrinsics = {
      {line.whole_number(2), line.whole_number(3)}, p[0], p[1], p[2] - centre_there, p[3] - centre_there};
  std::vector<double> lens(p.begin() + 4, p.end());
  if (terms == 1 || terms == 2) lens.resize(4, 0.0);  // k1[, k2], no tangential terms
  device.lens = lens_from_opencv(lens, "lens");
  return device;
}

std::map<int, Device> cameras_of(const std::string& text, const std::string& file) {
  std::map<int, Device> cameras;
  for (Lines line(text, file); line.next();)
    if (!cameras.emplace(line.whole_number(0), camera_of(line)).second)
      line.fail(fmt::format("a second camera {}", line.words()[0]));
  return cameras;
}

std::string model_text(const Device& device) {
  const Intrinsics& k = device.intrinsics;
  std::vector<double> lens = opencv_coefficients(device, "COLMAP", 8);
  const char* model = lens.empty() ? "PINHOLE" : lens.size() == 4 ? "OPENCV" : "FULL_OPENCV";
  if (lens.size() > 4) lens.resize(8, 0.0);
  std::vector<double> numbers = {k.fx, k.fy, k.cx + centre_there, k.cy + centre_there};
  numbers.insert(numbers.end(), lens.begin(), lens.end());
  return fmt::format("{} {} {} {}", model, k.size.x, k.size.y, joined(numbers, " "));
}

// "left/0001.png" to "left_0001": a rig's cameras are folders there.
std::string name_of(const std::string& image) {
  std::string name = std::filesystem::path(image).replace_extension().string();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

std::string pose_text(const Rigid& device_from_world) {
  const glm::dquat q = glm::normalize(glm::quat_cast(device_from_world.rotation));
  const glm::dvec3 t = device_from_world.translation;
  return joined(std::vector<double>{q.w, q.x, q.y, q.z, t.x, t.y, t.z}, " ");
}

}  // namespace

Rig parse_colmap(const std::string& cameras_txt, const std::string& images_txt, const std::string& folder) {
  const std::map<int, Device> cameras = cameras_of(cameras_txt, folder + "/cameras.txt");
  Rig rig;
  for (Lines line(images_txt, folder + "/images.txt"); line.next();) {
    if (line.words().size() < 10) line.fail("expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME");
    const auto camera = cameras.find(line.whole_number(8));
    if (camera == cameras.end()) line.fail(fmt::format("camera {} is not in cameras.txt", line.words()[8]));
    Device device = camera->second;
    device.name = name_of(line.words()[9]);
    device.device_from_world =
        rigid_from_quaternion({line.number(1), line.number(2), line.number(3), line.number(4)},
                              {line.number(5), line.number(6), line.number(7)});
    add_by_name(rig, std::move(device));
    line.next(false);  // its points
  }
  return rig;
}

ColmapText colmap_text(const Rig& rig, Notes& notes) {
  note_projectors(rig, "COLMAP", notes);
  ColmapText text{"# CAMERA_ID MODEL WIDTH HEIGHT PARAMS\n",
                  "# IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then POINTS2D\n"};
  int id = 0;
  for (const Device& device : devices_of(rig)) {
    text.cameras_txt += fmt::format("{} {}\n", ++id, model_text(device));
    if (device.name.find_first_of(" \t") != std::string::npos)
      throw InputError(fmt::format("COLMAP's names hold no blanks, found \"{}\"", device.name));
    text.images_txt +=
        fmt::format("{0} {1} {0} {2}.png\n\n", id, pose_text(device.device_from_world), device.name);
  }
  return text;
}

}  // namespace laterna
