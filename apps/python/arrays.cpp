#include "apps/python/arrays.h"

#include "sim/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace laterna::python {

namespace {

constexpr py::ssize_t longest = 16384;  // of a picture's side, as everywhere in Laterna

std::string shape_text(const py::array& array) { return std::string(py::str(array.attr("shape"))); }

std::string dtype_text(const py::array& array) { return std::string(py::str(array.dtype())); }

bool has_shape(const py::array& array, const Shape& shape) {
  if (array.ndim() != py::ssize_t(shape.size())) return false;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape[i] >= 0 && array.shape(py::ssize_t(i)) != shape[i]) return false;
  return true;
}

template <class Matrix>
py::array rows_of_matrix(const Matrix& matrix) {
  constexpr int n = Matrix::length();
  py::array_t<double> rows({n, n});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) rows.mutable_at(i, j) = matrix[j][i];
  return rows;
}

}  // namespace

py::array read_only(py::array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array matrix_of(const glm::dmat4& matrix) { return rows_of_matrix(matrix); }
py::array matrix_of(const glm::dmat3& matrix) { return rows_of_matrix(matrix); }

py::array expect(const py::object& argument, const Expected& expected) {
  const std::string dtypes = fmt::format("{}", fmt::join(expected.dtypes, " or "));
  if (!py::isinstance<py::array>(argument))
    throw InputError(fmt::format("{}: found a {}, expected a NumPy array of {}, {}", expected.name,
                                 std::string(py::str(py::type::of(argument).attr("__name__"))), dtypes,
                                 expected.shape_words));
  auto array = py::reinterpret_borrow<py::array>(argument);
  const std::string dtype = dtype_text(array);
  if (std::find(expected.dtypes.begin(), expected.dtypes.end(), dtype) == expected.dtypes.end())
    throw InputError(fmt::format("{}: dtype {}, expected {}", expected.name, dtype, dtypes));
  if (!has_shape(array, expected.shape))
    throw InputError(
        fmt::format("{}: shape {}, expected {}", expected.name, shape_text(array), expected.shape_words));
  if (!(array.flags() & py::array::c_style) || !(array.flags() & py::detail::npy_api::NPY_ARRAY_ALIGNED_))
    throw InputError(
        fmt::format("{}: the array is not C-contiguous, expected one that is: "
                    "numpy.ascontiguousarray({}) makes a copy",
                    expected.name, expected.name));
  return array;
}

std::span<const glm::dvec3> points_in(const py::array& array) {
  return {static_cast<const glm::dvec3*>(array.data()), std::size_t(array.shape(0))};
}

std::span<const glm::dvec2> pixels_in(const py::array& array) {
  return {static_cast<const glm::dvec2*>(array.data()), std::size_t(array.shape(0))};
}

PicturesArgument pictures_of(const py::object& argument) {
  const py::array array =
      expect(argument, {"pictures", {"uint8", "uint16"}, {-1, -1, -1}, "(pictures, height, width)"});
  const py::ssize_t count = array.shape(0), height = array.shape(1), width = array.shape(2);
  if (count < 1 || count > longest || height < 1 || height > longest || width < 1 || width > longest)
    throw InputError(
        fmt::format("pictures: shape {}, expected 1 to {} each way", shape_text(array), longest));
  if (array.itemsize() == 1)
    return {array, ImageStackView(int(width), int(height), int(count),
                                  static_cast<const std::uint8_t*>(array.data()))};
  return {array, ImageStackView(int(width), int(height), int(count),
                                static_cast<const std::uint16_t*>(array.data()))};
}

}  // namespace laterna::python
