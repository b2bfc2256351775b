#include "apps/lab/report/report_page.h"

#include "apps/lab/report/static_figures.h"
#include "sim/text_file.h"

#include <fmt/format.h>

#include <system_error>

namespace laterna {

using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

constexpr const char* style = R"(:root{color-scheme:light dark}
body{font:16px/1.5 system-ui,sans-serif;max-width:72rem;margin:0 auto;padding:1rem}
table{border-collapse:collapse}td,th{padding:.2rem .8rem .2rem 0;text-align:left}
figure{margin:1rem 0}img,svg{max-width:100%;height:auto}svg{background:#fff}
)";

std::string head(const Json& data, const std::string& css) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>{}: Laterna report</title>\n<style>{}</style>\n</head>\n",
      html_text(data.at("title").get<std::string>()), css);
}

// JSON between script tags: no "</script" and no "<!--" may stand in it.
std::string script_json(const Json& data) {
  std::string text = data.dump(), safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

// Four digits for people, all of them where a pointer rests.
std::string number_element(const Json& value) {
  std::string whole = html_text(value.dump());
  if (!value.is_number_float()) return whole;
  return fmt::format("<data value=\"{0}\" title=\"{0}\">{1:.4g}</data>", whole, value.get<double>());
}

std::string verdict_rows(const Json& data) {
  std::string rows;
  for (const Json& v : data.at("verdicts")) {
    rows += fmt::format("<h3>{}: {}</h3>\n<p>{}</p>\n<table>\n", html_text(v["of"].get<std::string>()),
                        html_text(v["status"].get<std::string>()), html_text(v["reason"].get<std::string>()));
    for (const Json& fact : v["facts"])
      rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{} {}</td></tr>\n",
                          html_text(fact["name"].get<std::string>()), number_element(fact["value"]),
                          html_text(fact["unit"].get<std::string>()));
    rows += "</table>\n";
  }
  return rows;
}

std::string figure_element(const StaticFigure& figure) {
  const std::string caption = html_text(figure.caption);
  const std::string drawn = figure.svg.empty()
                                ? fmt::format("<img src=\"{}\" alt=\"{}\">", html_text(figure.image), caption)
                                : figure.svg;
  return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", drawn, caption);
}

std::string static_page(const Json& data, const std::string& why) {
  std::string text = head(data, style) +
                     fmt::format("<body>\n<main>\n<h1>{}</h1>\n<p>{}</p>\n<h2>Verdict</h2>\n{}",
                                 html_text(data.at("title").get<std::string>()), why, verdict_rows(data));
  text += "<h2>Figures</h2>\n";
  for (const StaticFigure& figure : static_figures(data)) text += figure_element(figure);
  return text + "</main>\n</body>\n</html>\n";
}

}  // namespace

fs::path report_bundle() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (failed) return {};
  const fs::path beside = program.parent_path().parent_path();
  for (const fs::path& file : {beside / "report/report.js", beside / "share/laterna/report.js"})
    if (fs::is_regular_file(file, failed)) return file;
  return {};
}

std::string html_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::string static_report_page(const Json& data, StaticReason reason) {
  return static_page(
      data, reason == StaticReason::asked
                ? "These are static figures, as was asked for: no slider, no 3D view, no charts to explore."
                : "These are static figures: this Laterna was built without Node, so the page has no slider, "
                  "no 3D view and no charts to explore.");
}

std::string report_page(const Json& data, const fs::path& bundle) {
  const std::string script = read_text(bundle, std::size_t(64) << 20);
  return head(data, "") +
         "<body>\n<noscript><p>This page draws its figures with a script, which is switched off here; "
         "`laterna report --static` writes one that needs none.</p></noscript>\n<div id=\"report\"></div>\n"
         "<script type=\"application/json\" id=\"data\">" +
         script_json(data) + "</script>\n<script>" + script + "</script>\n</body>\n</html>\n";
}

}  // namespace laterna
