#include "apps/lab/runner.h"

#include "sim/error.h"
#include "sim/parallel.h"
#include "tests/testing.h"

#include <gmock/gmock.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <sstream>

namespace laterna {
namespace {

using ::testing::HasSubstr;
using testing::input_error;
using testing::ScratchFolder;

// Squares, with a count of how often any was worked out.
std::vector<Job> squares(int count, std::atomic<int>& worked) {
  std::vector<Job> jobs;
  for (int k = 0; k < count; ++k)
    jobs.push_back({"square " + std::to_string(k), [k, &worked] {
                      ++worked;
                      return nlohmann::json{{"value", k * k}};
                    }});
  return jobs;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Runner, ResultsComeInTheOrderOfTheJobs) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  const RunOutcome run = run_jobs(squares(50, worked), {.folder = folder / "a", .fingerprint = "f"});
  ASSERT_EQ(run.jobs.size(), 50u);
  EXPECT_EQ(run.done, 50u);
  EXPECT_FALSE(run.interrupted);
  for (int k = 0; k < 50; ++k) EXPECT_EQ(run.jobs[std::size_t(k)].result["value"], k * k);
}

// An interrupted run that is resumed works out the rest alone, and ends with what an uninterrupted one ends
// with.
TEST(Runner, AnInterruptedRunIsResumed) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  std::vector<Job> jobs = squares(40, worked);
  const auto square = jobs[7].work;
  jobs[7].work = [&, square] {
    std::raise(SIGINT);
    return square();
  };
  RunnerOptions options{.folder = folder / "a", .fingerprint = "f", .parallel = false};
  const RunOutcome first = run_jobs(jobs, options);
  EXPECT_TRUE(first.interrupted);
  EXPECT_EQ(first.done, 8u);
  options.resume = true;
  const RunOutcome second = run_jobs(squares(40, worked), options);
  EXPECT_FALSE(second.interrupted);
  EXPECT_EQ(worked, 40);
  for (int k = 0; k < 40; ++k) EXPECT_EQ(second.jobs[std::size_t(k)].result["value"], k * k);
}

// What a killed process leaves: a line cut short, and a job that began.
TEST(Runner, AKilledRunIsResumed) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  RunnerOptions options{.folder = folder / "a", .fingerprint = "f"};
  run_jobs(squares(3, worked), options);
  std::ofstream(folder / "a" / "journal.jsonl", std::ios::app) << "{\"begin\":\"square 3\"}\n{\"id\":\"squ";
  options.resume = true;
  const RunOutcome run = run_jobs(squares(5, worked), options);
  EXPECT_EQ(run.done, 5u);
  EXPECT_EQ(worked, 5);
  EXPECT_EQ(run.jobs[3].result["value"], 9);
  EXPECT_EQ(run_jobs(squares(5, worked), options).done, 5u);  // nothing is left to do
  EXPECT_EQ(worked, 5);
}

TEST(Runner, AJobThatThrowsOrKillsTwiceIsCrashedAndTheRestGoesOn) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  std::vector<Job> jobs = squares(4, worked);
  jobs[1].work = []() -> nlohmann::json { throw std::runtime_error("went wrong"); };
  RunnerOptions options{.folder = folder / "a", .fingerprint = "f"};
  const RunOutcome run = run_jobs(jobs, options);
  EXPECT_EQ(run.done, 4u);
  EXPECT_EQ(run.jobs[1].crashed, "went wrong");
  EXPECT_TRUE(run.jobs[1].result.is_null());
  std::ofstream(folder / "a" / "journal.jsonl", std::ios::app)
      << "{\"begin\":\"square 4\"}\n{\"begin\":\"square 4\"}\n";
  options.resume = true;
  EXPECT_THAT(run_jobs(squares(5, worked), options).jobs[4].crashed, HasSubstr("died"));
  EXPECT_EQ(run_jobs(squares(5, worked), options).jobs[1].crashed, "went wrong");
}

TEST(Runner, OnRequestAnExceptionEndsTheRunAndTheJobStaysToBeDone) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  std::vector<Job> jobs = squares(4, worked);
  jobs[1].work = []() -> nlohmann::json { throw InputError("the disk is full"); };
  RunnerOptions options{.folder = folder / "a", .fingerprint = "f", .parallel = false, .stop_at_error = true};
  EXPECT_EQ(input_error([&] { run_jobs(jobs, options); }), "the disk is full");
  EXPECT_EQ(worked, 1);
  options.resume = true;
  EXPECT_EQ(run_jobs(squares(4, worked), options).done, 4u);
  EXPECT_EQ(worked, 4);
}

// A process may die of its machine, not of the job, and before it wrote anything.
TEST(Runner, OnRequestNoNumberOfDeathsMakesACrash) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  std::filesystem::create_directories(folder / "a");
  testing::write_text(folder / "a" / "journal.jsonl", "{\"journal\":1,\"fing");
  const RunnerOptions options{
      .folder = folder / "a", .fingerprint = "f", .resume = true, .most_deaths = 1000};
  EXPECT_EQ(run_jobs(squares(2, worked), options).done, 2u);
  std::ofstream(folder / "a" / "journal.jsonl", std::ios::app)
      << "{\"begin\":\"square 2\"}\n{\"begin\":\"square 2\"}\n{\"begin\":\"square 2\"}\n";
  EXPECT_EQ(run_jobs(squares(3, worked), options).jobs[2].result["value"], 4);
}

// A person who presses ctrl-C between two runs of one command is heard by the next one.
TEST(Runner, AStopBetweenRunsHoldsForTheNext) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  const StopSignals over_all_runs;
  EXPECT_FALSE(run_jobs(squares(3, worked), {.folder = folder / "a", .fingerprint = "f"}).interrupted);
  std::raise(SIGINT);
  const RunOutcome next = run_jobs(squares(5, worked), {.folder = folder / "b", .fingerprint = "f"});
  EXPECT_TRUE(next.interrupted);
  EXPECT_EQ(next.done, 0u);
  EXPECT_EQ(worked, 3);
}

// The last job has ended, the result is not written yet: the person who pressed ctrl-C is heard.
TEST(Runner, AStopInTheLastJobIsHeard) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  std::vector<Job> jobs = squares(3, worked);
  const auto square = jobs[2].work;
  jobs[2].work = [&, square] {
    std::raise(SIGINT);
    return square();
  };
  RunnerOptions options{.folder = folder / "a", .fingerprint = "f", .parallel = false};
  const RunOutcome first = run_jobs(jobs, options);
  EXPECT_TRUE(first.interrupted);
  EXPECT_EQ(first.done, 3u);
  EXPECT_FALSE(StopSignals::asked());  // none lives any more
  options.resume = true;
  EXPECT_FALSE(run_jobs(jobs, options).interrupted);  // nothing is left to work out
  EXPECT_EQ(worked, 3);
}

TEST(Runner, BadInput) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  const RunnerOptions options{.folder = folder / "a", .fingerprint = "f"};
  RunnerOptions resumed = options;
  resumed.resume = true;
  EXPECT_THAT(input_error([&] { run_jobs(squares(2, worked), resumed); }), HasSubstr("holds no run"));
  run_jobs(squares(2, worked), options);
  EXPECT_THAT(input_error([&] { run_jobs(squares(2, worked), options); }), HasSubstr("--resume"));
  resumed.fingerprint = "g";
  EXPECT_THAT(input_error([&] { run_jobs(squares(2, worked), resumed); }),
              HasSubstr("begun with other words"));
  std::filesystem::create_directories(folder / "b");
  testing::write_text(folder / "b" / "journal.jsonl", "not a journal\nat all\n");
  resumed.folder = folder / "b";
  EXPECT_THAT(input_error([&] { run_jobs(squares(2, worked), resumed); }), HasSubstr("line 1"));
  testing::write_text(folder / "file", "");
  RunnerOptions nowhere = options;
  nowhere.folder = folder / "file" / "x";
  EXPECT_THAT(input_error([&] { run_jobs(squares(2, worked), nowhere); }), HasSubstr("expected a folder"));
}

TEST(Runner, ProgressTellsTheEnd) {
  const ScratchFolder folder;
  std::atomic<int> worked{0};
  std::string last;
  run_jobs(squares(3, worked),
           {.folder = folder / "a", .fingerprint = "f", .parallel = false, .noun = "cells"},
           [&](const std::string& line) { last = line; });
  EXPECT_EQ(last, "3 of 3 cells, 0:00 left");
  EXPECT_THAT(text_of(folder / "a" / "journal.jsonl"), HasSubstr("\"fingerprint\":\"f\""));
}

}  // namespace
}  // namespace laterna
