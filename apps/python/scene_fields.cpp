#include "apps/python/scene_fields.h"

#include "sim/error.h"
#include "sim/field_text.h"
#include "sim/scene_fields.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <sstream>

namespace laterna::python {

namespace py = pybind11;

namespace {

template <Described T>
py::dict dict_of(const T& noun);

template <class T>
py::object value_of(const T& value) {
  return py::cast(value);
}
template <Named T>
py::object value_of(const T& value) {
  return py::str(names_of(value)[std::size_t(value)]);
}
template <Described T>
py::object value_of(const T& noun) {
  return dict_of(noun);
}
template <glm::length_t n, class Number>
py::object value_of(const glm::vec<n, Number>& vector) {
  py::list list;
  for (glm::length_t i = 0; i < n; ++i) list.append(vector[i]);
  return list;
}
template <Described T>
py::object value_of(const std::vector<T>& nouns) {
  py::list list;
  for (const T& noun : nouns) list.append(dict_of(noun));
  return list;
}
template <class T>
py::object value_of(const std::optional<T>& value) {
  return value ? value_of(*value) : py::none();
}

struct DictWriter {
  py::dict dict;

  template <class T>
  void operator()(const Field& field, T& value) {
    dict[field.key] = value_of(value);
  }
};

template <Described T>
py::dict dict_of(const T& noun) {
  T visited = noun;
  DictWriter writer;
  describe(writer, visited);
  return writer.dict;
}

bool is_index(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
}

[[noreturn]] void no_such_key(const std::string& path, const std::string& word, const py::dict& table) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : table) keys.push_back(key.cast<std::string>());
  throw InputError(
      fmt::format("{}: unknown key \"{}\", did you mean \"{}\"?", path, word, nearest_key(word, keys)));
}

py::object item_of(const std::string& path, const py::list& list, std::size_t index) {
  if (index >= list.size())
    throw InputError(fmt::format("{}: no entry {}, expected fewer than {}", path, index, list.size()));
  return list[index];
}

std::string toml_of(const std::string& path, py::handle value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return toml_text(value.cast<std::string>());
  if (py::hasattr(value, "tolist")) return toml_of(path, value.attr("tolist")());  // NumPy's
  if (py::isinstance<py::int_>(value) || py::isinstance<py::float_>(value))
    return std::string(py::repr(value));
  if (!py::isinstance<py::list>(value) && !py::isinstance<py::tuple>(value))
    throw InputError(fmt::format("{}: a {} has no place in a scene, expected a number, a string or a list",
                                 path, std::string(py::str(py::type::of(value).attr("__name__")))));
  std::string items;
  for (const py::handle item : value) items += (items.empty() ? "" : ", ") + toml_of(path, item);
  return "[" + items + "]";
}

}  // namespace

py::dict fields_of(const SceneSpec& spec) { return dict_of(spec); }

py::object field_at(const SceneSpec& spec, const std::string& path) {
  py::object here = fields_of(spec);
  std::istringstream words(path);
  for (std::string word; std::getline(words, word, '.');) {
    const bool is_list = py::isinstance<py::list>(here);
    if (is_list && is_index(word)) {
      here = item_of(path, here, std::size_t(std::stoul(word.substr(0, 9))));
      continue;
    }
    if (is_list) here = item_of(path, here, 0);
    if (!py::isinstance<py::dict>(here))
      throw InputError(fmt::format("{}: there is no \"{}\" in a plain value", path, word));
    const auto table = py::reinterpret_borrow<py::dict>(here);
    if (!table.contains(word)) no_such_key(path, word, table);
    here = table[py::str(word)];
  }
  return here;
}

std::vector<std::string> overrides_of(const py::object& given) {
  std::vector<std::string> overrides;
  if (given.is_none()) return overrides;
  if (py::isinstance<py::dict>(given)) {
    for (const auto& [path, value] : py::reinterpret_borrow<py::dict>(given)) {
      const auto key = path.cast<std::string>();
      overrides.push_back(key + "=" + toml_of(key, value));
    }
    return overrides;
  }
  for (const py::handle text : py::reinterpret_borrow<py::list>(given)) {
    if (!py::isinstance<py::str>(text))
      throw InputError("overrides: expected texts such as \"ambient_lx=3\"");
    overrides.push_back(text.cast<std::string>());
  }
  return overrides;
}

}  // namespace laterna::python
