#include "sim/formats/usd_transform.h"

#include "sim/error.h"
#include "sim/formats/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace laterna {

namespace {

constexpr std::string_view prefix = "xformOp:";

// One entry of the order: "!invert!xformOp:translate:pivot".
struct Operation {
  std::string attribute, kind;  ///< xformOp:translate:pivot, translate
  bool inverse = false;
};

Operation operation_of(std::string entry, const std::string& place) {
  Operation op;
  constexpr std::string_view invert = "!invert!";
  op.inverse = entry.starts_with(invert);
  op.attribute = op.inverse ? entry.substr(invert.size()) : entry;
  if (!op.attribute.starts_with(prefix))
    throw InputError(fmt::format("{}: xformOpOrder: found \"{}\", expected xformOp:...", place, entry));
  const std::string rest = op.attribute.substr(prefix.size());
  op.kind = rest.substr(0, rest.find(':'));
  return op;
}

std::vector<Operation> order_of(const std::string& value, const std::string& place) {
  std::vector<Operation> order;
  for (std::size_t from = value.find('"'); from != value.npos; from = value.find('"', from + 1)) {
    const std::size_t to = value.find('"', from + 1);
    if (to == value.npos) break;
    order.push_back(operation_of(value.substr(from + 1, to - from - 1), place));
    from = to;
  }
  return order;
}

Rigid rotation_about(char axis, double degrees) {
  glm::dvec3 vector(0.0);
  vector[axis - 'X'] = glm::radians(degrees);
  return rigid_from_rotation_vector(vector, {});
}

bool is_rotation(const std::string& kind) {
  constexpr std::string_view name = "rotate";
  if (!kind.starts_with(name) || (kind.size() != 7 && kind.size() != 9)) return false;
  std::string axes = kind.substr(name.size());
  std::sort(axes.begin(), axes.end());
  return axes == "X" || axes == "Y" || axes == "Z" || axes == "XYZ";
}

// Its letters from the first to act to the last; angles stand by axis, not by letter.
Rigid rotation_of(const std::string& axes, const std::vector<double>& degrees) {
  Rigid rotation;
  for (const char axis : axes)
    rotation = compose(rotation_about(axis, axes.size() == 1 ? degrees[0] : degrees[std::size_t(axis - 'X')]),
                       rotation);
  return rotation;
}

Rigid transform_of(const std::vector<double>& m, double metres_per_unit, const std::string& place) {
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    throw InputError(place + ": expected 4 rows of 4 numbers with a last column of 0, 0, 0, 1");
  const std::vector<double> rows = {m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10]};  // row vectors
  return rigid_from_rotation_rows(rows, glm::dvec3(m[12], m[13], m[14]) * metres_per_unit, place);
}

Rigid motion_of(const Operation& op, const std::string& value, double metres_per_unit,
                const std::string& place) {
  const std::vector<double> n = usd_numbers(value, place);
  const auto expect = [&](std::size_t count) {
    if (n.size() != count)
      throw InputError(fmt::format("{}: found {} numbers, expected {}", place, n.size(), count));
  };
  if (op.kind == "translate") {
    expect(3);
    return {glm::dmat3(1.0), glm::dvec3(n[0], n[1], n[2]) * metres_per_unit};
  }
  if (is_rotation(op.kind)) {
    expect(op.kind.size() == 7 ? 1 : 3);
    return rotation_of(op.kind.substr(6), n);
  }
  if (op.kind == "orient") {
    expect(4);
    return rigid_from_quaternion({n[0], n[1], n[2], n[3]}, {});
  }
  if (op.kind == "transform") {
    expect(16);
    return transform_of(n, metres_per_unit, place);
  }
  if (op.kind == "scale" && std::all_of(n.begin(), n.end(), [](double s) { return s == 1; })) return {};
  throw InputError(
      fmt::format("{}: expected a translation, a rotation or a rigid transform, found {}", place, value));
}

}  // namespace

std::vector<double> usd_numbers(const std::string& value, const std::string& place) {
  std::vector<double> numbers;
  constexpr std::string_view between = "()[], \t\r\n";
  for (std::size_t at = value.find_first_not_of(between); at != value.npos;
       at = value.find_first_not_of(between, at)) {
    const std::size_t end = std::min(value.find_first_of(between, at), value.size());
    double number = 0;
    if (!read_number(std::string_view(value).substr(at, end - at), number))
      throw InputError(fmt::format("{}: found \"{}\", expected numbers", place,
                                   value.substr(at, std::min<std::size_t>(end - at, 40))));
    numbers.push_back(number);
    at = end;
  }
  return numbers;
}

Rigid usd_parent_from_prim(const std::map<std::string, std::string>& attributes, double metres_per_unit,
                           const std::string& place) {
  const auto order = attributes.find("xformOpOrder");
  if (order == attributes.end()) {
    const auto first = attributes.lower_bound(std::string(prefix));
    if (first != attributes.end() && first->first.starts_with(prefix))
      throw InputError(fmt::format("{}: {} without an xformOpOrder, expected one", place, first->first));
    return {};
  }
  Rigid parent_from_prim;
  for (const Operation& op : order_of(order->second, place)) {
    const auto value = attributes.find(op.attribute);
    if (value == attributes.end())
      throw InputError(fmt::format("{}: {} is in xformOpOrder and missing", place, op.attribute));
    const Rigid motion =
        motion_of(op, value->second, metres_per_unit, fmt::format("{}: {}", place, op.attribute));
    parent_from_prim = compose(parent_from_prim, op.inverse ? inverse(motion) : motion);
  }
  return parent_from_prim;
}

}  // namespace laterna
