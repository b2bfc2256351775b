// The reference of an atlas as cells that a heat map draws.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace laterna {

/// Of {"conditions", "seeds", "methods", "hidden", "letters": {CELL: LETTERS}}, as data/atlas stores it:
/// {"name", "summary": the same without the letters, "cells": [{"grid", "cell", "method": "laterna",
/// "hidden", "letters", "right", "weak", "refused", "silent", "crashed"}]}. A reference does not say which
/// cells no data can reveal: they are those of grids whose name ends with "what no data can reveal". Throws
/// InputError, beginning with `place`, where the cells are not as many by outcome as the summary says.
nlohmann::json stored_atlas(const nlohmann::json& reference, const std::string& name,
                            const std::string& place);

}  // namespace laterna
