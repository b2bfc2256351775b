#include "sim/cameramodel_file.h"

#include "sim/error.h"
#include "sim/text_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <vector>

extern "C" {
#include <mrcal/mrcal.h>
}

namespace laterna {

namespace {

constexpr std::size_t most_bytes = std::size_t(64) << 20;

struct Free {
  void operator()(mrcal_cameramodel_t* model) const { mrcal_free_cameramodel(&model); }
};
using Model = std::unique_ptr<mrcal_cameramodel_t, Free>;

std::string model_name(const mrcal_lensmodel_t& lensmodel) {
  char name[1024];
  if (!mrcal_lensmodel_name(name, sizeof name, &lensmodel)) return "unknown";
  return name;
}

Device device_of(const mrcal_cameramodel_t& model) {
  Device device;
  const double* k = model.intrinsics;
  device.intrinsics = {{int(model.imagersize[0]), int(model.imagersize[1])}, k[0], k[1], k[2], k[3]};
  device.lens.model = model_name(model.lensmodel);
  const int count = lens_parameter_count(device.lens.model);
  device.lens.parameters.assign(k + 4, k + 4 + count);
  const double* rt = model.rt_cam_ref;
  device.device_from_world = rigid_from_rotation_vector({rt[0], rt[1], rt[2]}, {rt[3], rt[4], rt[5]});
  rigid_from_rows(rows_of(device.device_from_world), "extrinsics");
  return device;
}

/// mrcal's scanner (2.2) looks for the end of a string or comment past the end of the text.
void expect_strings_that_end(const std::string& text, const std::string& file_name) {
  int line = 1, begun = 0;
  char inside = 0;  // a quote, # or nothing
  for (const char c : text) {
    const bool ends = inside == '#' ? c == '\n' : c == inside;
    if (inside != 0 ? ends : c == '\'' || c == '"' || c == '#') {
      inside = inside != 0 ? char(0) : c;
      begun = line;
    }
    line += c == '\n';
  }
  if (inside != 0 && inside != '#')
    throw InputError(fmt::format("{}:{}: a string begins here and never ends", file_name, begun));
}

}  // namespace

Device read_cameramodel(const std::filesystem::path& path) {
  Device device = parse_cameramodel(read_text(path, most_bytes), path.string());
  device.name = path.stem().string();
  return device;
}

Device parse_cameramodel(const std::string& text, const std::string& file_name) {
  check_text(text, file_name);
  expect_strings_that_end(text, file_name);
  const Model model(mrcal_read_cameramodel_string((text + "\n").c_str(), 0));
  if (!model) {
    throw InputError(
        fmt::format("{}: mrcal's parser finds no camera model in it, expected lensmodel, intrinsics, "
                    "extrinsics and imagersize",
                    file_name));
  }
  try {
    Device device = device_of(*model);
    device.name = "device";
    validate(device);
    device.name.clear();
    return device;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file_name, error.what()));
  }
}

std::string cameramodel_text(const Device& device) {
  const Intrinsics& k = device.intrinsics;
  std::vector<double> numbers = {k.fx, k.fy, k.cx, k.cy};
  numbers.insert(numbers.end(), device.lens.parameters.begin(), device.lens.parameters.end());
  const glm::dvec3 r = rotation_vector_rad(device.device_from_world.rotation);
  const glm::dvec3 t = device.device_from_world.translation;
  return fmt::format(
      "# The coordinate order is: a Rodrigues rotation vector, then a translation, from the reference to the "
      "camera.\n{{\n"
      "    'lensmodel':  '{}',\n"
      "    'intrinsics': [ {} ],\n"
      "    'extrinsics': [ {}, {}, {}, {}, {}, {} ],\n"
      "    'imagersize': [ {}, {} ],\n}}\n",
      device.lens.model, fmt::join(numbers, ", "), r.x, r.y, r.z, t.x, t.y, t.z, k.size.x, k.size.y);
}

}  // namespace laterna
