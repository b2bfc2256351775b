// Many independent jobs: in parallel, journalled, resumable, with the same results in whatever order they
// ran.
#pragma once

#include "apps/lab/files_digest.h"
#include "apps/lab/simulation.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace laterna {

/// One thing to do. `work` depends on nothing but what it captures; its result is kept as JSON.
struct Job {
  std::string id;  ///< unique among the jobs of a run, the same in every run
  std::function<nlohmann::json()> work;
};

struct RunnerOptions {
  std::filesystem::path folder;     ///< of the journal; made where it is not there
  std::string fingerprint;          ///< of the words that the results depend on beside the ids
  std::vector<FileDigest> files{};  ///< that they depend on: the specification first
  bool resume = false;              ///< go on where the journal ends
  bool parallel = true;             ///< false: one after the other, for jobs that measure seconds
  std::string noun = "jobs";        ///< for progress: "cells", "points"
  bool stop_at_error = false;  ///< an exception of a job ends the run and is thrown; the job stays to be done
  int most_deaths = 2;         ///< of the process in one job, which then counts as crashed
};

/// While one lives, SIGINT and SIGTERM only ask to stop, once each: run_jobs() then begins no job. Those that
/// live inside another add nothing to it, so that a command holds one over all its runs, and until its result
/// is written. Not for several threads.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  /// Whether a signal came since the outermost one that lives was made; false where none lives.
  static bool asked();
};

/// How a job ended.
struct JobOutcome {
  nlohmann::json result;  ///< null where not done or crashed
  std::string crashed;    ///< what was thrown, or that the process died of it twice; empty: it did not
  bool done = false;      ///< with a result or crashed
};

struct RunOutcome {
  std::vector<JobOutcome> jobs;  ///< in the order of the jobs
  std::size_t done = 0;
  bool interrupted = false;  ///< by SIGINT or SIGTERM, be it in the last job: the run can be resumed
};

/// Runs the jobs that the journal has no end of. FOLDER/journal.jsonl gets a line when a job begins and one,
/// whole, when it ends, so that nothing finished is lost, however the run ends. An exception of a job is its
/// outcome, not the run's, unless the options say otherwise; a job in which the process died is tried once
/// more and then counts as crashed. SIGINT and SIGTERM let the jobs in hand finish; a second one ends the
/// process. Progress comes at most every two seconds, with the time left.
///
/// Throws InputError where the folder holds a journal and `resume` is off, or it holds none and `resume` is
/// on; where the journal is of another fingerprint, or is no journal; where a file has changed since it was
/// begun, by name; where it cannot be written. A last line cut short is no fault, and neither is a journal of
/// which nothing else was written yet.
RunOutcome run_jobs(const std::vector<Job>& jobs, const RunnerOptions& options,
                    const Progress& progress = {});

}  // namespace laterna
