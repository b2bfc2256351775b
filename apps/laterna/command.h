// What the subcommands share. One thin file per subcommand: it parses words, calls the lab, prints.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace laterna {

/// Exit codes; the README's table documents them.
enum ExitCode {
  exit_ok = 0,
  exit_internal = 1,
  exit_bad_input = 2,
  exit_refused = 3,
  exit_weak = 4,
  exit_interrupted = 5
};

/// Options that every subcommand takes.
struct Common {
  int threads = 0;
  bool json = false;
  std::string isa;  ///< cap on the instruction set; empty: none
  std::uint64_t seed = 1;
  int exit_code = exit_ok;  ///< set by the subcommand that ran
};

/// Adds a subcommand whose help begins with a working example.
CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& example,
                      const std::string& sentence);

void add_new(CLI::App& app, Common& common);
void add_check(CLI::App& app, Common& common);
void add_info(CLI::App& app, Common& common);
void add_project(CLI::App& app, Common& common);
void add_preview(CLI::App& app, Common& common);
void add_live(CLI::App& app, Common& common);
void add_patterns(CLI::App& app, Common& common);
void add_capture(CLI::App& app, Common& common);
void add_render(CLI::App& app, Common& common);
void add_dataset(CLI::App& app, Common& common);
void add_decode(CLI::App& app, Common& common);
void add_convert(CLI::App& app, Common& common);
void add_calibrate(CLI::App& app, Common& common);
void add_selfcal(CLI::App& app, Common& common);
void add_verify(CLI::App& app, Common& common);
void add_roundtrip(CLI::App& app, Common& common);
void add_atlas(CLI::App& app, Common& common);
void add_chart(CLI::App& app, Common& common);
void add_classics(CLI::App& app, Common& common);
void add_plan(CLI::App& app, Common& common);
void add_report(CLI::App& app, Common& common);
void add_score(CLI::App& app, Common& common);

/// A line of progress on standard error, unless --json is on.
void progress(const Common& common, const std::string& line);

/// Throws InputError where a file to write (empty: none) exists already, or its folder does not.
void check_output(const std::string& out);

/// The help of the command and of each of its subcommands, as one Markdown page.
std::string command_reference_markdown(const CLI::App& app);

/// "1920x1080" to a size. Throws InputError for anything else.
std::array<int, 2> parse_size(const std::string& text, const char* option);

}  // namespace laterna
