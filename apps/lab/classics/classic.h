// One of the classic systems of projective textures, as it runs here: pictures, figures, charts.
#pragma once

#include "apps/lab/canvas.h"
#include "apps/lab/classics/line_chart.h"

#include <filesystem>
#include <string>
#include <vector>

namespace laterna {

struct ClassicPicture {
  std::string name;  ///< of its file, without ".png"; begins with the classic's name
  Canvas canvas;
};

struct ClassicFigure {
  std::string name;
  double value = 0;
  std::string unit{};    ///< empty: a ratio or a count
  double tolerance = 0;  ///< by how much another machine may find another value
};

/// What a classic leaves.
struct ClassicResult {
  std::vector<ClassicPicture> pictures;
  std::vector<ClassicFigure> figures;
  std::vector<LineChart> charts;
};

/// A system with its name, and a function that makes what must be seen from the scenes in a folder
/// (data/classics). Throws InputError where the folder lacks one of its files.
struct Classic {
  const char* name;
  const char* system;
  const char* must_be_seen;
  ClassicResult (*make)(const std::filesystem::path& scenes);
};

/// The figure of that name. Throws std::logic_error where there is none.
double figure(const ClassicResult& result, const std::string& name);

}  // namespace laterna
