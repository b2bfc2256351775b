#include "apps/lab/runner.h"

#include "sim/error.h"
#include "sim/parallel.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <exception>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <sstream>

namespace laterna {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t stop_asked = 0;
int stop_signals_alive = 0;
struct sigaction before_int {};
struct sigaction before_term {};

/// What a journal tells of its jobs.
struct Past {
  std::map<std::string, Json> ends;
  std::map<std::string, int> begun;  // and not ended
};

Json parse_line(const std::string& line, const fs::path& path, std::size_t number) {
  Json json = Json::parse(line, nullptr, false);
  if (!json.is_discarded() && json.is_object()) return json;
  throw InputError(fmt::format("{}: line {} is no JSON object, expected a journal of this command",
                               path.string(), number));
}

Past read_journal(const fs::path& path, const RunnerOptions& options) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  if (lines.empty()) throw InputError(path.string() + ": is empty, expected a journal of this command");
  Past past;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    const Json json = parse_line(lines[n], path, n + 1);
    if (n == 0) {
      if (json.value("journal", 0) != 1) throw InputError(path.string() + ": no journal of this command");
      if (json.value("fingerprint", "") != options.fingerprint)
        throw InputError(
            fmt::format("{}: begun with other words, expected the same to go on with it", path.string()));
      expect_unchanged(options.files, json.value("files", Json::object()), path);
    } else if (json.contains("begin")) {
      ++past.begun[json["begin"].get<std::string>()];
    } else if (json.contains("id")) {
      past.begun.erase(json["id"].get<std::string>());
      past.ends[json["id"].get<std::string>()] = json;
    }
  }
  return past;
}

/// Appends whole lines. What did not fit on the disk is taken back.
class Journal {
 public:
  Journal(fs::path path, bool is_new, const RunnerOptions& options)
      : path_(std::move(path)),
        file_(::open(path_.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0666)) {
    if (file_ < 0)
      throw InputError(fmt::format("{}: cannot be written, expected a folder for results", path_.string()));
    if (is_new)
      write({{"journal", 1}, {"fingerprint", options.fingerprint}, {"files", json_of(options.files)}});
  }
  ~Journal() { ::close(file_); }
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  void write(const Json& json) {
    const std::string line = json.dump() + "\n";
    const std::scoped_lock lock(mutex_);
    struct stat before {};
    if (::fstat(file_, &before) == 0 && ::write(file_, line.data(), line.size()) == ssize_t(line.size()))
      return;
    [[maybe_unused]] const int taken_back = ::ftruncate(file_, before.st_size);
    throw InputError(fmt::format("{}: cannot be written (is the disk full?)", path_.string()));
  }

 private:
  fs::path path_;
  int file_;
  std::mutex mutex_;
};

// The process may have died while it wrote the last line.
void drop_cut_line(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  const std::string text = all.str();
  const std::size_t whole = text.rfind('\n') + 1;  // npos + 1 is 0
  if (whole < text.size()) fs::resize_file(path, whole);
}

/// Tells how far a run is, now and then.
class ProgressClock {
 public:
  ProgressClock(const Progress& progress, std::string noun, std::size_t all, std::size_t done)
      : progress_(progress), noun_(std::move(noun)), all_(all), before_(done), done_(done) {}
  void one_more() {
    const std::scoped_lock lock(mutex_);
    ++done_;
    const auto now = Clock::now();
    if (!progress_ || (now - told_ < std::chrono::seconds(2) && done_ < all_)) return;
    told_ = now;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const auto left = std::lround(seconds / double(done_ - before_) * double(all_ - done_));
    progress_(fmt::format("{} of {} {}, {}:{:02} left", done_, all_, noun_, left / 60, left % 60));
  }

 private:
  const Progress& progress_;
  std::string noun_;
  std::size_t all_, before_, done_;
  Clock::time_point start_ = Clock::now(), told_ = start_;
  std::mutex mutex_;
};

JobOutcome outcome_of(const Json& end) {
  if (end.contains("crashed")) return {{}, end["crashed"].get<std::string>(), true};
  return {end.at("result"), "", true};
}

Json end_of(const Job& job) {
  try {
    return {{"id", job.id}, {"result", job.work()}};
  } catch (const std::exception& error) {
    return {{"id", job.id}, {"crashed", error.what()}};
  }
}

Past past_of(const fs::path& journal, const RunnerOptions& options) {
  const bool there = fs::exists(journal);
  if (there && !options.resume)
    throw InputError(
        fmt::format("{}: holds a run already, expected a new folder, or --resume to go on with it",
                    options.folder.string()));
  if (!there && options.resume)
    throw InputError(fmt::format("{}: holds no run, expected one to resume", options.folder.string()));
  if (!there) return {};
  drop_cut_line(journal);
  return fs::file_size(journal) > 0 ? read_journal(journal, options) : Past{};
}

}  // namespace

StopSignals::StopSignals() {
  if (stop_signals_alive++ > 0) return;
  stop_asked = 0;
  struct sigaction action {};
  action.sa_handler = [](int) { stop_asked = 1; };
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, &before_int);
  sigaction(SIGTERM, &action, &before_term);
}

StopSignals::~StopSignals() {
  if (--stop_signals_alive > 0) return;
  sigaction(SIGINT, &before_int, nullptr);
  sigaction(SIGTERM, &before_term, nullptr);
}

bool StopSignals::asked() { return stop_signals_alive > 0 && stop_asked; }

RunOutcome run_jobs(const std::vector<Job>& jobs, const RunnerOptions& options, const Progress& progress) {
  std::error_code failed;
  fs::create_directories(options.folder, failed);
  if (failed)
    throw InputError(
        fmt::format("{}: {}, expected a folder for results", options.folder.string(), failed.message()));
  const fs::path path = options.folder / "journal.jsonl";
  const Past past = past_of(path, options);
  Journal journal(path, !fs::exists(path) || fs::file_size(path) == 0, options);
  RunOutcome run{std::vector<JobOutcome>(jobs.size()), 0, false};
  std::vector<std::size_t> open;
  for (std::size_t k = 0; k < jobs.size(); ++k) {
    if (const auto end = past.ends.find(jobs[k].id); end != past.ends.end()) {
      run.jobs[k] = outcome_of(end->second);
    } else if (const auto begun = past.begun.find(jobs[k].id);
               begun != past.begun.end() && begun->second >= options.most_deaths) {
      const Json death{{"id", jobs[k].id}, {"crashed", "the process died of it"}};
      journal.write(death);
      run.jobs[k] = outcome_of(death);
    } else {
      open.push_back(k);
    }
  }
  ProgressClock clock(progress, options.noun, jobs.size(), jobs.size() - open.size());
  const StopSignals signals;
  // No exception leaves a body: it would cancel the loops inside the jobs in hand, which would not know.
  std::exception_ptr fault;
  std::mutex fault_mutex;
  std::atomic<bool> failed_once = false;
  const auto one = [&](std::size_t n) {
    if (stop_asked || failed_once) return;
    try {
      const Job& job = jobs[open[n]];
      journal.write({{"begin", job.id}});
      const Json end = options.stop_at_error ? Json{{"id", job.id}, {"result", job.work()}} : end_of(job);
      journal.write(end);
      run.jobs[open[n]] = outcome_of(end);
      clock.one_more();
    } catch (...) {
      const std::scoped_lock lock(fault_mutex);
      if (!fault) fault = std::current_exception();
      failed_once = true;
    }
  };
  if (options.parallel)
    parallel_for(open.size(), one);
  else
    for (std::size_t n = 0; n < open.size(); ++n) one(n);
  if (fault) std::rethrow_exception(fault);
  for (const JobOutcome& job : run.jobs) run.done += job.done;
  run.interrupted = run.done < jobs.size() || StopSignals::asked();
  return run;
}

}  // namespace laterna
