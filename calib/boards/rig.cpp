#include "calib/boards/rig.h"

#include "sim/error.h"
#include "sim/lens.h"
#include "sim/spline_knots.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace laterna {

namespace {

// A term and the lens parameters [begin, end) that it frees.
struct Term {
  const char* name;
  int begin, end;
};
constexpr std::array<Term, 6> all_terms = {
    {{"k1", 0, 1}, {"k2", 1, 2}, {"p1p2", 2, 4}, {"k3", 4, 5}, {"k456", 5, 8}, {"s1234", 8, 12}}};

struct Word {
  const char* word;
  int terms;
};
constexpr std::array<Word, 8> all_words = {{{"pinhole", 0},
                                            {"k1", 1},
                                            {"k1k2", 2},
                                            {"k1k2p1p2", 3},
                                            {"opencv4", 3},
                                            {"opencv5", 4},
                                            {"opencv8", 5},
                                            {"opencv12", 6}}};

const Term* find_term(const std::string& name) {
  const auto found =
      std::find_if(all_terms.begin(), all_terms.end(), [&](const Term& t) { return name == t.name; });
  return found == all_terms.end() ? nullptr : &*found;
}

Rigid turned(const Rigid& rigid, const double* step) {
  const Rigid turn = rigid_from_rotation_vector({step[0], step[1], step[2]}, glm::dvec3(0.0));
  return {turn.rotation * rigid.rotation, rigid.translation + glm::dvec3(step[3], step[4], step[5])};
}

}  // namespace

DeviceModel model_of_terms(const std::vector<std::string>& terms) {
  DeviceModel model;
  if (terms.size() == 1 && is_splined(terms[0])) {
    model.lens_model = terms[0];
    model.lens_free.assign(std::size_t(lens_parameter_count(terms[0])), true);
    model.held_core = true;
    return model;
  }
  int last = 0;
  std::vector<bool> free(12, false);
  for (const std::string& name : terms) {
    const Term* term = find_term(name);
    if (!term)
      throw InputError(fmt::format("lens term is \"{}\", expected k1, k2, p1p2, k3, k456 or s1234", name));
    for (int i = term->begin; i < term->end; ++i) free[i] = true;
    last = std::max(last, term->end);
  }
  const int count = last == 0 ? 0 : last <= 4 ? 4 : last <= 5 ? 5 : last <= 8 ? 8 : 12;
  if (count > 0) model.lens_model = fmt::format("LENSMODEL_OPENCV{}", count);
  free.resize(count);
  model.lens_free = std::move(free);
  return model;
}

bool are_splined(const std::vector<std::string>& terms) {
  return terms.size() == 1 && (terms[0] == "splined" || is_splined(terms[0]));
}

std::vector<std::string> lens_terms(const std::string& word) {
  std::vector<std::string> terms;
  if (is_splined(word)) lens_parameter_count(word);  // or throws
  if (are_splined({word})) return {word};
  for (const Word& w : all_words) {
    if (word != w.word) continue;
    for (int i = 0; i < w.terms; ++i) terms.emplace_back(all_terms[i].name);
    return terms;
  }
  for (std::size_t begin = 0; begin <= word.size();) {
    const std::size_t end = std::min(word.find('+', begin), word.size());
    terms.push_back(word.substr(begin, end - begin));
    if (!find_term(terms.back())) {
      throw InputError(fmt::format(
          "lens is \"{}\", expected auto, pinhole, k1, k1k2, k1k2p1p2, opencv4, opencv5, opencv8, opencv12, "
          "splined, or terms out of k1, k2, p1p2, k3, k456, s1234 joined by +",
          word));
    }
    begin = end + 1;
  }
  return terms;
}

std::string terms_text(const std::vector<std::string>& terms) {
  if (terms.size() == 1 && is_splined(terms[0])) {
    std::string grid = terms[0].substr(terms[0].find("_Nx=") + 4);  // 9_Ny=6_fov_x_deg=45
    return fmt::format("splined {}x{}", grid.substr(0, grid.find('_')),
                       grid.substr(grid.find("_Ny=") + 4, grid.find("_fov") - grid.find("_Ny=") - 4));
  }
  return terms.empty() ? "pinhole" : fmt::format("{}", fmt::join(terms, "+"));
}

RigColumns columns_of(const RigModel& model) {
  RigColumns columns;
  for (std::size_t d = 0; d < model.devices.size(); ++d) {
    const DeviceModel& m = model.devices[d];
    RigColumns::Of of;
    of.intrinsics.assign(4 + m.lens_free.size(), -1);
    if (!m.held && !m.known) {
      if (!m.held_core) {
        of.intrinsics[0] = columns.count++;
        of.intrinsics[1] = m.one_focal_length ? of.intrinsics[0] : columns.count++;
        for (int i = 2; i < 4 && !m.fixed_center; ++i) of.intrinsics[i] = columns.count++;
      }
      for (std::size_t i = 0; i < m.lens_free.size(); ++i)
        if (m.lens_free[i]) of.intrinsics[4 + i] = columns.count++;
    }
    if (d > 0 && !m.held) of.pose = columns.count, columns.count += 6;
    columns.devices.push_back(std::move(of));
  }
  if (model.bend) columns.bend = columns.count, columns.count += 2;
  return columns;
}

std::string lens_parameter_name(const std::string& lens_model, int index) {
  constexpr std::array<const char*, 12> names = {"k1", "k2", "p1", "p2", "k3", "k4",
                                                 "k5", "k6", "s1", "s2", "s3", "s4"};
  if (lens_model.starts_with("LENSMODEL_OPENCV") && index < int(names.size())) return names[index];
  if (is_splined(lens_model)) return fmt::format("knot{}_{}", index / 2, index % 2 == 0 ? 'x' : 'y');
  return fmt::format("lens{}", index);
}

std::vector<std::string> column_names(const RigModel& model, const BoardCapture& capture) {
  const RigColumns columns = columns_of(model);
  std::vector<std::string> names(columns.count);
  constexpr std::array<const char*, 4> pinhole = {"fx", "fy", "cx", "cy"};
  constexpr std::array<const char*, 6> pose = {"rotation_x",    "rotation_y",    "rotation_z",
                                               "translation_x", "translation_y", "translation_z"};
  for (std::size_t d = 0; d < model.devices.size(); ++d) {
    const std::string prefix = capture.devices[d].name + " ";
    const RigColumns::Of& of = columns.devices[d];
    for (int i = int(of.intrinsics.size()) - 1; i >= 0; --i) {  // backwards: a shared column is named fx
      if (of.intrinsics[i] < 0) continue;
      names[of.intrinsics[i]] =
          prefix + (i < 4 ? pinhole[i] : lens_parameter_name(model.devices[d].lens_model, i - 4));
    }
    for (int i = 0; i < 6 && of.pose >= 0; ++i) names[of.pose + i] = prefix + pose[i];
  }
  if (columns.bend >= 0) names[columns.bend] = "bend_x", names[columns.bend + 1] = "bend_y";
  return names;
}

BoardRig moved(const BoardRig& rig, const RigColumns& columns, const std::vector<double>& global,
               const std::vector<double>& poses) {
  BoardRig result = rig;
  for (std::size_t d = 0; d < rig.devices.size(); ++d) {
    const RigColumns::Of& of = columns.devices[d];
    for (std::size_t i = 0; i < of.intrinsics.size(); ++i)
      if (of.intrinsics[i] >= 0) result.devices[d].parameters[i] += global[of.intrinsics[i]];
    if (of.pose >= 0)
      result.devices[d].device_from_camera = turned(rig.devices[d].device_from_camera, &global[of.pose]);
  }
  if (columns.bend >= 0) result.bend += glm::dvec2(global[columns.bend], global[columns.bend + 1]);
  for (std::size_t k = 0; k < rig.camera_from_board.size() && !poses.empty(); ++k)
    result.camera_from_board[k] = turned(rig.camera_from_board[k], &poses[6 * k]);
  return result;
}

std::vector<double> global_step(const BoardRig& from, const BoardRig& to, const RigColumns& columns) {
  std::vector<double> step(columns.count, 0.0);
  for (std::size_t d = 0; d < from.devices.size(); ++d) {
    const RigColumns::Of& of = columns.devices[d];
    const RigDevice &a = from.devices[d], &b = to.devices[d];
    for (std::size_t i = 0; i < of.intrinsics.size(); ++i)
      if (of.intrinsics[i] >= 0) step[of.intrinsics[i]] = b.parameters[i] - a.parameters[i];
    if (of.pose < 0) continue;
    const Rigid &p = a.device_from_camera, &q = b.device_from_camera;
    const glm::dvec3 w = rotation_vector_rad(q.rotation * glm::transpose(p.rotation));
    for (int i = 0; i < 3; ++i)
      step[of.pose + i] = w[i], step[of.pose + 3 + i] = q.translation[i] - p.translation[i];
  }
  for (int i = 0; i < 2 && columns.bend >= 0; ++i) step[columns.bend + i] = to.bend[i] - from.bend[i];
  return step;
}

BoardRig fitted_to(BoardRig rig, const RigModel& model, const BoardCapture& capture) {
  for (std::size_t d = 0; d < rig.devices.size(); ++d) {
    const DeviceModel& m = model.devices[d];
    std::vector<double>& k = rig.devices[d].parameters;
    if (m.held_core && k.size() != 4 + m.lens_free.size() && !m.prior.empty()) k = m.prior.mean;
    k.resize(4 + m.lens_free.size(), 0.0);
    if (m.one_focal_length) k[0] = k[1] = std::sqrt(k[0] * k[1]);
    if (m.fixed_center)
      for (int i = 0; i < 2; ++i) k[2 + i] = (capture.devices[d].size[i] - 1) / 2.0;
  }
  if (!model.bend) rig.bend = glm::dvec2(0.0);
  return rig;
}

Device device_of(const BoardRig& rig, const RigModel& model, const BoardCapture& capture, int d) {
  const std::vector<double>& k = rig.devices[d].parameters;
  Device device;
  device.name = capture.devices[d].name;
  device.intrinsics = {capture.devices[d].size, k[0], k[1], k[2], k[3]};
  device.device_from_world = rig.devices[d].device_from_camera;
  device.lens = {model.devices[d].lens_model, {k.begin() + 4, k.end()}};
  return device;
}

}  // namespace laterna
