// A printed board in several places, as a table of what was seen, to a camera and a projector.
#include "apps/lab/board_json.h"
#include "apps/lab/trial_report.h"
#include "apps/python/arrays.h"
#include "apps/python/json_value.h"
#include "apps/python/long_call.h"
#include "apps/python/module.h"
#include "calib/boards/correspondence_csv.h"
#include "sim/error.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <limits>

namespace laterna::python {

namespace {

struct Column {
  std::string name;
  py::array_t<double> numbers;
};

// Columns of numbers as the table that calibrate() of the command reads, so that both judge it alike.
std::string table_text(const py::object& given) {
  std::vector<Column> columns;
  std::string text;
  for (const py::handle name : given.attr("keys")()) {
    columns.push_back(
        {name.cast<std::string>(), py::array_t<double>::ensure(given.attr("__getitem__")(name))});
    const Column& column = columns.back();
    if (!column.numbers || column.numbers.ndim() != 1 || column.numbers.size() != columns[0].numbers.size())
      throw InputError(
          fmt::format("table: column \"{}\" is not (N,) numbers, N as of the first column", column.name));
    text += (columns.size() > 1 ? "," : "") + column.name;
  }
  text += "\n";
  for (py::ssize_t row = 0; !columns.empty() && row < columns[0].numbers.size(); ++row) {
    for (std::size_t c = 0; c < columns.size(); ++c)
      text += fmt::format("{}{}", c ? "," : "", columns[c].numbers.at(row));
    text += "\n";
  }
  return text;
}

BoardCapture capture_of(const py::object& table, glm::ivec2 camera_size, glm::ivec2 projector_size) {
  if (py::isinstance<py::dict>(table))
    return parse_correspondence_csv(table_text(table), "table", camera_size, projector_size);
  const auto path = py::str(table).cast<std::string>();
  return without_lock([&] { return read_correspondence_csv(path, camera_size, projector_size); });
}

BoardCalibration calibrate(const py::object& table, std::array<int, 2> camera_size,
                           std::array<int, 2> projector_size, const std::string& lens, double tolerance_px) {
  const BoardCapture capture =
      capture_of(table, {camera_size[0], camera_size[1]}, {projector_size[0], projector_size[1]});
  BoardOptions options;
  options.tolerance_px = tolerance_px;
  if (lens != "auto") options.terms.assign(capture.devices.size(), lens_terms(lens));
  return without_lock([&] { return calibrate_boards(capture, options); });
}

double held_out_px(const BoardCalibration& c) {
  return c.status == Status::refused || c.held_out().folds.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                                   : c.held_out().rms_px;
}

}  // namespace

void bind_boards(py::module_& module) {
  py::class_<BoardCalibration>(module, "BoardCalibration",
                               "A camera and a projector, from a board in several places.")
      .def_property_readonly(
          "status", [](const BoardCalibration& c) { return status_word(c.status); },
          "\"ok\", \"weak\" or \"refused\", as of Estimate.")
      .def_readonly("reason", &BoardCalibration::reason, "Why it is not ok; else empty.")
      .def_readonly("devices", &BoardCalibration::devices,
                    "Camera and projector; device_from_world is device_from_camera, in the table's unit. "
                    "Empty where refused.")
      .def_property_readonly(
          "fit_rms_px",
          [](const BoardCalibration& c) {
            return c.status == Status::refused ? std::numeric_limits<double>::quiet_NaN() : c.fit_rms_px();
          },
          "Residuals of the projector, sqrt(mean(du² + dv²)); NaN where refused.")
      .def_property_readonly("held_out_rms_px", &held_out_px,
                             "The same in poses that the solve never saw; NaN where none could be left out.")
      .def(
          "as_dict", [](const BoardCalibration& c) { return value_of(board_json(c)); },
          "What `laterna calibrate FILE.csv --json` prints.");
  module.def("calibrate_boards", &calibrate, py::arg("table"), py::arg("camera_size"),
             py::arg("projector_size"), py::arg("lens") = "auto",
             py::arg("tolerance_px") = BoardOptions{}.tolerance_px,
             "table: a CSV file's path, or a dictionary of columns of N numbers: pose, corner, board_x, "
             "board_y, board_z (any unit), "
             "cam_x, cam_y, proj_x, proj_y (px), valid (1 or 0). Sizes: (width, height). lens: auto, or a "
             "word such as pinhole, k1, opencv5.");
}

}  // namespace laterna::python
