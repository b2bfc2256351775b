#include "apps/laterna/command.h"

#include "sim/error.h"
#include "sim/instruction_sets.h"
#include "sim/parallel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>

namespace laterna {

CLI::App* add_command(CLI::App& app, const std::string& name, const std::string& example,
                      const std::string& sentence) {
  return app.add_subcommand(name, "Example: " + example + "\n\n" + sentence);
}

void progress(const Common& common, const std::string& line) {
  if (!common.json) fmt::print(stderr, "{}\n", line);
}

std::array<int, 2> parse_size(const std::string& text, const char* option) {
  std::array<int, 2> size{};
  int used = 0;
  if (std::sscanf(text.c_str(), "%dx%d%n", &size[0], &size[1], &used) != 2 || used != int(text.size())) {
    throw InputError(fmt::format("{}: found \"{}\", expected WIDTHxHEIGHT such as 1920x1080", option, text));
  }
  return size;
}

void check_output(const std::string& out) {
  if (out.empty()) return;
  if (std::filesystem::exists(out))
    throw InputError(fmt::format("{} exists already, expected a new file", out));
  const auto parent = std::filesystem::absolute(out).parent_path();
  if (!std::filesystem::is_directory(parent))
    throw InputError(fmt::format("{}: no such folder, expected one to write into", parent.string()));
  if (::access(parent.c_str(), W_OK) != 0)
    throw InputError(fmt::format("{}: {}, expected a folder to write into", parent.string(),
                                 std::generic_category().message(errno)));
}

namespace {

std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

int run(int argc, char** argv) {
  Common common;
  CLI::App app{
      "Example: laterna new > scene.toml && laterna roundtrip scene.toml\n\n"
      "Laterna casts calibration patterns from a simulated projector onto meshes, photographs them with a "
      "simulated camera,\n"
      "decodes the pictures, recovers the projector, and says how far its texture matrix is from the true "
      "one."};
  app.name("laterna");
  app.set_version_flag("--version", LATERNA_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  app.add_option("--threads", common.threads, "Threads; 0: as many as the machine has")
      ->check(CLI::Range(0, 4096));
  app.add_option("--seed", common.seed, "Seed of everything random; the same seed gives the same bits");
  app.add_option(
      "--isa", common.isa,
      fmt::format("Uses no more than this instruction set: {}", fmt::join(instruction_set_names(), ", ")));
  app.add_flag("--json", common.json, "Prints JSON for machines on standard output, and nothing else there");
  for (const auto add : {add_new,      add_check,    add_info,    add_project, add_preview,   add_live,
                         add_patterns, add_capture,  add_dataset, add_render,  add_decode,    add_calibrate,
                         add_selfcal,  add_verify,   add_score,   add_convert, add_roundtrip, add_atlas,
                         add_chart,    add_classics, add_plan,    add_report}) {
    add(app, common);
  }
  app.add_flag_callback(
      "--command-reference",
      [&app] {
        fmt::print("{}", command_reference_markdown(app));
        throw CLI::Success();
      },
      "Prints the help of every subcommand (Markdown)");
  app.parse_complete_callback([&] {
    set_thread_count(common.threads);
    cap_instruction_set(common.isa);
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    fmt::print(stderr, "laterna: {}; see laterna --help\n", one_line(error.what()));
    return exit_bad_input;
  }
  return common.exit_code;
}

}  // namespace
}  // namespace laterna

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // beyond `ulimit -f` a write then fails, and the command says so
  try {
    return laterna::run(argc, argv);
  } catch (const laterna::InputError& error) {
    fmt::print(stderr, "laterna: {}\n", error.what());
    return laterna::exit_bad_input;
  } catch (const laterna::Refusal& error) {
    fmt::print(stderr, "laterna: refused: {}\n", error.what());
    return laterna::exit_refused;
  } catch (const std::exception& error) {
    fmt::print(stderr, "laterna: internal error: {}\n", error.what());
    return laterna::exit_internal;
  }
}
