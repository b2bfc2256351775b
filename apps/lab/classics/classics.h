// The classic systems by name, and the folder that they leave.
#pragma once

#include "apps/lab/classics/classic.h"

#include <nlohmann/json.hpp>

#include <span>

namespace laterna {

/// Every classic, in the order of the page (data/classics/README.md).
std::span<const Classic> all_classics();

/// The classics of these names in the table's order; no name: all. Throws InputError, listing the known
/// ones, for a name that there is not.
std::vector<Classic> find_classics(const std::vector<std::string>& names);

/// A classic and what it made.
struct MadeClassic {
  Classic classic;
  ClassicResult result;
};
std::vector<MadeClassic> make_classics(const std::vector<Classic>& classics,
                                       const std::filesystem::path& scenes);

/// {NAME: {system, must_be_seen, pictures: [file], figures: {name: {value, unit, tolerance}},
/// charts: {name: {title, x, y, series: [{name, tolerance, points}]}}}}
nlohmann::json classics_json(const std::vector<MadeClassic>& made);

/// "  name  value unit", line by line, for people.
std::string classics_text(const std::vector<MadeClassic>& made);

/// Leaves the folder `out`, which must be new, whole or not at all: NAME.png of each picture, NAME.svg of
/// each chart, classics.json. Throws InputError as PendingFolder does.
void write_classics(const std::vector<MadeClassic>& made, const std::filesystem::path& out);

}  // namespace laterna
