// A report as one HTML file that opens offline.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace laterna {

/// The browser's part of the page, as apps/report bundles it: report.js, beside the program in the build
/// folder (../report) or installed (../share/laterna). Empty where it is in neither.
std::filesystem::path report_bundle();

/// The page of report_data(): with the bundle, the data and a script that draws them; where `bundle` is
/// empty, the same numbers with static SVG figures (static_figures.h) and a sentence that says so. Nothing is
/// loaded from elsewhere. Throws InputError where the bundle cannot be read.
std::string report_page(const nlohmann::json& data, const std::filesystem::path& bundle);

/// Text for HTML: & < > " ' escaped.
std::string html_text(const std::string& text);

}  // namespace laterna
