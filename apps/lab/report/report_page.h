// A report as one HTML file that opens offline.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace laterna {

/// The browser's part of the page, as apps/report bundles it: report.js, beside the program in the build
/// folder (../report) or installed (../share/laterna). Empty where it is in neither.
std::filesystem::path report_bundle();

/// The page of report_data(): the data, and the bundle's script that draws them. Nothing is loaded from
/// elsewhere. Throws InputError where the bundle cannot be read.
std::string report_page(const nlohmann::json& data, const std::filesystem::path& bundle);

enum class StaticReason { asked, no_bundle };

/// The same verdicts with static figures (static_figures.h), without a script, and a sentence that says why.
std::string static_report_page(const nlohmann::json& data, StaticReason reason);

/// Text for HTML: & < > " ' escaped.
std::string html_text(const std::string& text);

}  // namespace laterna
