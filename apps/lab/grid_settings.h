// The settings of a grid (grid_file.h), read with care. Each throws InputError, beginning with the grid's
// place, for a value of a wrong type or out of range, and gives the default where the key is not there.
#pragma once

#include "apps/lab/grid_file.h"

#include <string>
#include <vector>

namespace laterna {

/// A whole number from 1 to a million.
int count_setting(const Grid& grid, const char* key, int otherwise);

/// A number above 0.
double positive_setting(const Grid& grid, const char* key, double otherwise);

bool flag_setting(const Grid& grid, const char* key);

std::string word_setting(const Grid& grid, const char* key, const std::string& otherwise);

/// "methods": a name or a list of names, each one of `known`.
std::vector<std::string> methods_setting(const Grid& grid, const std::vector<std::string>& known);

}  // namespace laterna
