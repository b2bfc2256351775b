// Pictures to projector pixels.
#include "apps/python/arrays.h"
#include "apps/python/long_call.h"
#include "apps/python/module.h"
#include "calib/decode.h"

#include <pybind11/stl.h>

namespace laterna::python {

Decoded decoded(const CapturedView& pictures, const PatternSequence& patterns, const DecodeOptions& options) {
  Decoded result{patterns, decode(pictures, patterns, options), {}};
  result.report = report_on(pictures, patterns, result.map);
  return result;
}

namespace {

Decoded decode_pictures(const py::object& pictures, const PatternSequence& patterns,
                        double min_white_minus_black_dn, bool subpixel) {
  const PicturesArgument argument = pictures_of(pictures);
  DecodeOptions options;
  options.gray.min_white_minus_black_dn = options.phase.min_white_minus_black_dn = min_white_minus_black_dn;
  options.gray.subpixel = subpixel;
  return without_lock([&] { return decoded(argument.view, patterns, options); });
}

// The address of the pixels that decode() reads: for tests of what is copied.
std::uintptr_t address_of(const py::object& pictures) {
  return std::visit([](const auto& view) { return reinterpret_cast<std::uintptr_t>(view.data); },
                    pictures_of(pictures).view);
}

template <class T>
auto map_of(Image<T> DecodedMap::*map) {
  return [map](const py::object& self) {
    const Image<T>& image = self.cast<const Decoded&>().map.*map;
    return array_in(self, image.values.data(), {image.height, image.width});
  };
}

}  // namespace

void bind_decode(py::module_& module) {
  const GrayDecodeOptions d;
  py::class_<Decoded>(module, "Decoded",
                      "For each camera pixel the projector pixel that lit it. Arrays are (height, width) of "
                      "the camera, in the map's "
                      "own memory: what is written there is what calibrate() reads.")
      .def_property_readonly(
          "u_px", map_of(&DecodedMap::u_px),
          "float64: column of the projector, integers at pixel centres; NaN where not valid.")
      .def_property_readonly("v_px", map_of(&DecodedMap::v_px), "float64: row of the projector.")
      .def_property_readonly("sigma_px", map_of(&DecodedMap::sigma_px),
                             "float32: one standard deviation of u and of v; NaN where not valid.")
      .def_property_readonly("valid", map_of(&DecodedMap::valid), "uint8: 1 or 0.")
      .def_property_readonly("confidence", map_of(&DecodedMap::confidence), "float32: 0 (no signal) to 1.")
      .def_property_readonly(
          "patterns", [](const Decoded& m) { return m.patterns; }, "What was shown.")
      .def_property_readonly(
          "rejected_percent",
          [](const Decoded& m) {
            py::dict shares;
            for (int reason = 1; reason < reject_reasons; ++reason)
              shares[reject_name(Reject(reason))] = m.report.percent[std::size_t(reason)];
            return shares;
          },
          "Share of all pixels by the reason why they tell nothing.")
      .def_property_readonly(
          "valid_percent", [](const Decoded& m) { return m.report.valid_percent; },
          "Share of all pixels, when decoded.")
      .def_property_readonly(
          "flags", [](const Decoded& m) { return m.report.flags; },
          "What looks wrong in the pictures, in words; empty where nothing does.");
  module.def(
      "decode", &decode_pictures, py::arg("pictures"), py::arg("patterns"),
      py::arg("min_white_minus_black_dn") = d.min_white_minus_black_dn, py::arg("subpixel") = d.subpixel,
      "pictures: uint8 or uint16 (pictures, height, width), C-contiguous, read in place, simulated or real. "
      "subpixel: Gray and XOR codes, places between pixels where the camera resolves them.");
  module.def("_address", &address_of, py::arg("pictures"));
}

}  // namespace laterna::python
