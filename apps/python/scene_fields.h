// A scene's fields as Python values, by the description that readers and writers of scene files share
// (sim/scene_fields.h): nothing is listed again.
#pragma once

#include "sim/scene_spec.h"

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace laterna::python {

/// Nested dictionaries and lists, keys as in the file; None where a field without a default is absent. Sizes,
/// vectors and matrices are lists of numbers, enumerations their names.
pybind11::dict fields_of(const SceneSpec& spec);

/// The value at a path as parse_scene() takes it: keys and indices joined by dots, an index left out is 0.
/// Throws InputError, naming the nearest key, where there is none.
pybind11::object field_at(const SceneSpec& spec, const std::string& path);

/// "KEY=VALUE" texts from what a caller gave: None, a list of such texts, or a mapping of paths to Python
/// values. Throws InputError for a value that has no TOML form.
std::vector<std::string> overrides_of(const pybind11::object& given);

}  // namespace laterna::python
