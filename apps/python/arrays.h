// NumPy arrays to C++ memory and back, without copies.
#pragma once

#include "sim/image_view.h"

#include <pybind11/numpy.h>
#include <glm/glm.hpp>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace laterna::python {

namespace py = pybind11;
using Shape = std::vector<py::ssize_t>;

/// An array of memory that `owner` holds, which lives as long as the array does. Writing goes into that
/// memory.
template <class T>
py::array array_in(py::handle owner, const T* data, Shape shape) {
  return py::array(py::dtype::of<T>(), std::move(shape), data, owner);
}

/// An array of points or pixels: N or height × width of them, each a row of numbers.
template <int n>
py::array array_in(py::handle owner, const glm::vec<n, double>* data, Shape shape) {
  shape.push_back(n);
  return py::array(py::dtype::of<double>(), std::move(shape), reinterpret_cast<const double*>(data), owner);
}

/// An array that has taken over a vector of C++.
template <class Vector>
py::array array_of(Vector&& values, Shape shape) {
  auto* held = new std::remove_cvref_t<Vector>(std::forward<Vector>(values));
  const py::capsule owner(held,
                          [](void* memory) { delete static_cast<std::remove_cvref_t<Vector>*>(memory); });
  return array_in(owner, held->data(), std::move(shape));
}

/// The same array, which refuses to be written.
py::array read_only(py::array array);

/// Row-major copies of small matrices.
py::array matrix_of(const glm::dmat4& matrix);
py::array matrix_of(const glm::dmat3& matrix);

/// What is expected of an array that is read in place; -1 is any length.
struct Expected {
  const char* name;                 ///< the argument's, for messages
  std::vector<std::string> dtypes;  ///< NumPy's names
  Shape shape;
  const char* shape_words;  ///< "(pictures, height, width)"
};

/// The argument as an array. Throws InputError, with one sentence that names the argument, what was found and
/// what was expected, for another object, dtype, number of dimensions, length or byte order, and for memory
/// that is not C-contiguous and aligned.
py::array expect(const py::object& argument, const Expected& expected);

/// N×3 or N×2 of float64 as points, in the array's own memory. `array` must outlive the span.
std::span<const glm::dvec3> points_in(const py::array& array);
std::span<const glm::dvec2> pixels_in(const py::array& array);

/// A stack of pictures, in the array's own memory: uint8 or uint16 of (pictures, height, width).
struct PicturesArgument {
  py::array array;
  CapturedView view;
};
PicturesArgument pictures_of(const py::object& argument);

}  // namespace laterna::python
