#include "sim/formats/usd_camera.h"

#include "sim/error.h"
#include "sim/formats/usd_transform.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>

namespace laterna {

namespace {

// Comments become blanks of the same length, so that places stand; those in strings are none.
std::string without_comments(std::string text) {
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '"') quoted = !quoted;
    if (text[i] == '#' && !quoted)
      for (; i < text.size() && text[i] != '\n'; ++i) text[i] = ' ';
  }
  return text;
}

struct Prim {
  std::string type, name;
  Rigid world_from_parent{};
  std::map<std::string, std::string> attributes;
};

class Reader {
 public:
  Reader(const std::string& text, glm::ivec2 camera_size, std::string file)
      : text_(without_comments(text)), camera_size_(camera_size), file_(std::move(file)) {}

  Rig read() {
    read_metadata();
    while (skip_blanks()) {
      if (text_[at_] == '}')
        close();
      else
        statement();
    }
    if (!open_.empty()) fail("the text ends inside a prim");
    return std::move(rig_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    const auto line =
        1 + std::count(text_.begin(), text_.begin() + std::ptrdiff_t(std::min(at_, text_.size())), '\n');
    throw InputError(fmt::format("{}:{}: {}", file_, line, what));
  }

  bool skip_blanks() {
    at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size());
    return at_ < text_.size();
  }

  // The place after a bracket's partner; strings are passed over.
  std::size_t after_bracket(std::size_t from) const {
    int depth = 0;
    for (std::size_t i = from; i < text_.size(); ++i) {
      if (text_[i] == '"') {
        i = text_.find('"', i + 1);
        if (i == text_.npos) fail("an unclosed string");
      }
      if (text_[i] == '(' || text_[i] == '[') ++depth;
      if ((text_[i] == ')' || text_[i] == ']') && --depth == 0) return i + 1;
    }
    fail("an unclosed bracket");
  }

  void read_metadata() {
    if (!skip_blanks() || text_[at_] != '(') return;
    const std::size_t end = after_bracket(at_);
    const std::string metadata = text_.substr(at_, end - at_);
    if (const std::size_t key = metadata.find("metersPerUnit"); key != metadata.npos) {
      const std::size_t equals = metadata.find('=', key), stop = metadata.find_first_of("\n)", key);
      if (equals > stop) fail("metersPerUnit without a number");
      const std::vector<double> unit = usd_numbers(metadata.substr(equals + 1, stop - equals - 1), file_);
      if (unit.size() != 1 || !(unit[0] > 0)) fail("metersPerUnit, expected a number above 0");
      metres_per_unit_ = unit[0];
    }
    at_ = end;
  }

  // "def Type "name" (metadata) {" or "type name = value".
  void statement() {
    const std::size_t stop = text_.find_first_of("={(", at_);
    if (stop == text_.npos) fail("neither a prim nor an attribute");
    std::vector<std::string> words = words_of(text_.substr(at_, stop - at_));
    if (words.empty()) fail("found a bracket, expected a prim or an attribute");
    if (words[0] == "def" || words[0] == "over" || words[0] == "class") {
      open_prim(words, stop);
    } else if (text_[stop] == '=') {
      if (open_.empty()) fail("an attribute outside a prim");
      at_ = stop + 1;
      attribute(words.back());
    } else {
      fail(fmt::format("found \"{}\", expected a prim or an attribute", words[0]));
    }
  }

  static std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    constexpr std::string_view blanks = " \t\r\n";
    for (std::size_t at = text.find_first_not_of(blanks); at != text.npos;
         at = text.find_first_not_of(blanks, at)) {
      const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
      words.push_back(text.substr(at, end - at));
      at = end;
    }
    return words;
  }

  void open_prim(const std::vector<std::string>& words, std::size_t stop) {
    if (open_.size() >= std::size_t(deepest_tree))
      fail(fmt::format("prims nest deeper than {}", deepest_tree));
    const std::string& name = words.back();
    if (words.size() < 2 || name.size() < 3 || name.front() != '"' || name.back() != '"')
      fail("a prim without a name");
    at_ = text_[stop] == '(' ? after_bracket(stop) : stop;
    if (!skip_blanks() || text_[at_] != '{') fail("a prim without {");
    ++at_;
    Prim prim;
    prim.type = words.size() == 3 ? words[1] : "";
    prim.name = name.substr(1, name.size() - 2);
    if (!open_.empty()) prim.world_from_parent = world_from(open_.back());
    open_.push_back(std::move(prim));
  }

  void attribute(const std::string& name) {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    if (at_ >= text_.size()) fail(name + ": without a value");
    std::size_t end = std::min(text_.find('\n', at_), text_.size());
    if (text_[at_] == '(' || text_[at_] == '[' || text_[at_] == '{')
      end = text_[at_] == '{' ? end : after_bracket(at_);
    const std::string value = text_.substr(at_, end - at_);
    if (name.find(".timeSamples") != name.npos) fail(name + ": expected a camera that stands still");
    Prim& prim = open_.back();
    prim.attributes[name] = value;
    at_ = end;
    if (prim.attributes.size() > 10000) fail("more than 10000 attributes");
  }

  // Operations stand before the prims inside.
  Rigid world_from(const Prim& prim) const {
    return compose(prim.world_from_parent,
                   usd_parent_from_prim(prim.attributes, metres_per_unit_, file_ + ": " + prim.name));
  }

  void close() {
    if (open_.empty()) fail("a } without its {");
    const Prim prim = std::move(open_.back());
    open_.pop_back();
    ++at_;
    if (prim.type == "Camera") add_camera(prim);
  }

  double number(const Prim& prim, const std::string& key, double otherwise) const {
    const auto found = prim.attributes.find(key);
    if (found == prim.attributes.end()) return otherwise;
    const std::vector<double> numbers = usd_numbers(found->second, file_ + ": " + prim.name + "." + key);
    if (numbers.size() != 1) fail(fmt::format("{}.{}: expected a number", prim.name, key));
    return numbers[0];
  }

  static std::string text_at(const Prim& prim, const std::string& key) {
    const auto found = prim.attributes.find(key);
    if (found == prim.attributes.end()) return "";
    const std::size_t first = found->second.find('"'), last = found->second.rfind('"');
    return first == last ? "" : found->second.substr(first + 1, last - first - 1);
  }

  glm::ivec2 size_of(const Prim& prim) const {
    const auto found = prim.attributes.find("laterna:size");
    if (found == prim.attributes.end()) {
      if (camera_size_.x == 0)
        fail(fmt::format("OpenUSD does not say the picture's size of \"{}\", expected --camera-size WxH",
                         prim.name));
      return camera_size_;
    }
    const std::vector<double> size = usd_numbers(found->second, file_);
    if (size.size() != 2 || !is_whole(size[0]) || !is_whole(size[1]))
      fail("laterna:size: expected width and height");
    return {int(size[0]), int(size[1])};
  }

  void add_camera(const Prim& prim) {
    const glm::ivec2 size = size_of(prim);
    // UsdGeomCamera's own defaults.
    const double f = number(prim, "focalLength", 50), w = number(prim, "horizontalAperture", 20.955),
                 h = number(prim, "verticalAperture", 15.2908);
    if (!(f > 0 && w > 0 && h > 0))
      fail(fmt::format("\"{}\": focal length and apertures are above 0", prim.name));
    Device device;
    device.name = prim.name;
    const double s = 0.5 - number(prim, "horizontalApertureOffset", 0) / w,
                 t = 0.5 - number(prim, "verticalApertureOffset", 0) / h;
    const glm::dvec2 center_px = pixel_from_texture({s, t, 0, 1}, size);
    device.intrinsics = {size, f / w * size.x, f / h * size.y, center_px.x, center_px.y};
    if (const std::string model = text_at(prim, "laterna:lensModel"); !model.empty()) {
      const auto parameters = prim.attributes.find("laterna:lensParameters");
      device.lens = {model, parameters == prim.attributes.end() ? std::vector<double>{}
                                                                : usd_numbers(parameters->second, file_)};
    }
    device.device_from_world = compose(view_from_device(), inverse(world_from(prim)));
    const std::string kind = text_at(prim, "laterna:kind");
    if (kind.empty())
      add_by_name(rig_, std::move(device));
    else
      (kind == "projector" ? rig_.projectors : rig_.cameras).push_back(std::move(device));
  }

  std::string text_;
  glm::ivec2 camera_size_;
  std::string file_;
  std::size_t at_ = 0;
  double metres_per_unit_ = 0.01;
  std::vector<Prim> open_;
  Rig rig_;
};

std::string transform_text(const Rigid& world_from_camera) {
  const glm::dmat3& r = world_from_camera.rotation;  // its columns are the rows for row vectors
  const glm::dvec3& t = world_from_camera.translation;
  return fmt::format("( ({}, {}, {}, 0), ({}, {}, {}, 0), ({}, {}, {}, 0), ({}, {}, {}, 1) )", r[0].x, r[0].y,
                     r[0].z, r[1].x, r[1].y, r[1].z, r[2].x, r[2].y, r[2].z, t.x, t.y, t.z);
}

std::string camera_text(const Device& d, const char* kind) {
  const Intrinsics& k = d.intrinsics;
  const double f = 50, w = f * k.size.x / k.fx, h = f * k.size.y / k.fy;
  const glm::dvec2 offset = (0.5 - texture_from_pixel({k.cx, k.cy}, k.size)) * glm::dvec2(w, h);
  return fmt::format(
      "def Camera \"{}\"\n{{\n    token projection = \"perspective\"\n    float focalLength = {}\n"
      "    float horizontalAperture = {}\n    float verticalAperture = {}\n"
      "    float horizontalApertureOffset = {}\n    float verticalApertureOffset = {}\n"
      "    matrix4d xformOp:transform = {}\n    uniform token[] xformOpOrder = [\"xformOp:transform\"]\n"
      "    custom int2 laterna:size = ({}, {})\n    custom string laterna:kind = \"{}\"\n"
      "    custom string laterna:lensModel = \"{}\"\n    custom double[] laterna:lensParameters = [{}]\n}}\n",
      d.name, f, w, h, offset.x, offset.y,
      transform_text(compose(inverse(d.device_from_world), view_from_device())), k.size.x, k.size.y, kind,
      d.lens.model, joined(d.lens.parameters));
}

}  // namespace

Rig parse_usd_cameras(const std::string& text, glm::ivec2 camera_size, const std::string& file_name) {
  check_text(text, file_name);
  if (!text.starts_with("#usda"))
    throw InputError(file_name + ":1: found no #usda, expected a stage of OpenUSD as text");
  return Reader(text, camera_size, file_name).read();
}

std::string usd_camera_text(const Rig& rig, Notes& notes) {
  std::string text = "#usda 1.0\n(\n    metersPerUnit = 1\n    upAxis = \"Z\"\n)\n";
  for (const Device& d : devices_of(rig)) {
    const bool projects = std::any_of(rig.projectors.begin(), rig.projectors.end(),
                                      [&](const Device& p) { return p.name == d.name; });
    if (!std::all_of(d.name.begin(), d.name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_'; }))
      throw InputError(fmt::format("OpenUSD's names are letters, digits and _, found \"{}\"", d.name));
    if (projects || !is_pinhole(d.lens))
      notes.push_back(fmt::format("OpenUSD holds no {}: of \"{}\" only attributes laterna: tell",
                                  projects ? "projector" : "lens", d.name));
    text += "\n" + camera_text(d, projects ? "projector" : "camera");
  }
  return text;
}

}  // namespace laterna
