// What a study does about other programs: it notices them, and draws no conclusion from what they disturbed.

#include "study/disturbance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "study/build_id.h"
#include "study/conclusions.h"
#include "study/figure1.h"
#include "study/names.h"
#include "study/plan.h"
#include "study/tune.h"
#include "study/write.h"

namespace alhazen::impl::study {
namespace {

ThreadStatistics thread_of(double busy, double processor) {
  ThreadStatistics thread;
  thread.busy_seconds = busy;
  thread.processor_seconds = processor;
  return thread;
}

TEST(StudyDisturbance, FractionIsThatOfTheThreadThatLostMost) {
  const RunUsage unused;
  EXPECT_NEAR(processor_fraction(unused, {thread_of(1, 1), thread_of(1, 1)}, 2), 1, 1e-12);
  EXPECT_NEAR(processor_fraction(unused, {thread_of(1, 0.5), thread_of(1, 1)}, 2), 0.5, 1e-12);
  EXPECT_NEAR(processor_fraction(unused, {thread_of(0.5, 0.5), thread_of(1, 1)}, 2), 1, 1e-12);  // one ends early
  // One of many: all together received 97 %.
  std::vector<ThreadStatistics> many(8, thread_of(1, 1));
  many[3].processor_seconds = 0.7;
  EXPECT_NEAR(processor_fraction(unused, many, 8), 0.7, 1e-12);
  // A thread with hardly any work.
  EXPECT_GT(processor_fraction(unused, {thread_of(1, 1), thread_of(0.001, 0.0001)}, 2), 0.99);
}

TEST(StudyDisturbance, FractionOfThreadsThatShareProcessors) {
  const std::vector<ThreadStatistics> four(4, thread_of(1, 0.5));
  EXPECT_NEAR(processor_fraction({1, 2, 0}, four, 2), 1, 1e-12);
  EXPECT_NEAR(processor_fraction({1, 1.5, 0}, four, 2), 0.75, 1e-12);
  EXPECT_NEAR(processor_fraction({1, 1.5, 0.5}, four, 2), 1, 1e-12);  // the rest of the time was idle
  // Threads that do not know their processor time.
  EXPECT_NEAR(processor_fraction({1, 1.5, 0}, {thread_of(0.9, 0), thread_of(0.9, 0)}, 2), 0.75, 1e-12);
}

TEST(StudyDisturbance, SpreadLeavesOutTheSlowestQuarter) {
  EXPECT_EQ(steady_spread({}), 0);
  EXPECT_EQ(steady_spread({3}), 0);
  EXPECT_NEAR(steady_spread({1.0, 1.1, 1.2}), 0.2 / 1.1, 1e-12);
  EXPECT_NEAR(steady_spread({1.0, 9.0, 1.02, 1.04}), 0.04 / 1.03, 1e-12);
}

TEST(StudyDisturbance, IdleTimeGrowsButNotFasterThanTime) {
  const double before = idle_seconds(), after = idle_seconds();
  EXPECT_GE(before, 0);
  EXPECT_GE(after, before);
}

Trial steady_trial(const std::string& key, const std::vector<double>& seconds, uint64_t samples) {
  Trial trial;
  trial.key = key;
  trial.status = TrialStatus::ok;
  trial.seconds = seconds;
  trial.busy_seconds.assign(seconds.size(), {1.0, 1.0});
  trial.processor_fractions.assign(seconds.size(), 1.0);
  trial.switches.assign(seconds.size(), 0);
  trial.width = trial.height = 10;
  trial.samples_per_pixel = 1;
  trial.samples = samples;
  trial.rays = 2 * samples;
  return trial;
}

TEST(StudyDisturbance, RunsToRepeat) {
  Trial trial = steady_trial("a", {1, 1.5, 1.02, 1.01}, 100);
  EXPECT_EQ(runs_to_repeat(trial), (std::vector<bool>{false, false, false, false}));
  trial.processor_fractions[2] = 0.5;
  EXPECT_EQ(runs_to_repeat(trial), (std::vector<bool>{false, true, true, false}));
  EXPECT_EQ(runs_to_repeat(steady_trial("a", {1, 1.5}, 100)), (std::vector<bool>{false, true}));
}

TEST(StudyDisturbance, DoubtSaysWhy) {
  EXPECT_EQ(doubt_of(steady_trial("a", {1, 1.01, 1.02}, 100), 3), "");
  EXPECT_EQ(doubt_of(steady_trial("a", {1}, 100), 1), "");
  EXPECT_EQ(doubt_of(steady_trial("a", {1}, 100), 3), "measured 1 of 3 times");
  EXPECT_EQ(doubt_of(steady_trial("a", {1, 1.2, 1.1}, 100), 3), "repeats differ by 18 %");
  Trial trial = steady_trial("a", {1, 1, 1}, 100);
  trial.processor_fractions[1] = 0.89;
  EXPECT_EQ(doubt_of(trial, 3), "in 1 of 3 runs other programs used processors");
}

/// All trials of two processors measured, on two threads with equal work.
Study measured_study() {
  Study study;
  study.is_complete = true;
  study.machine.processors = 2;
  study.scene.width = study.scene.height = 800;
  study.scene.spheres = 1006;
  study.scale.repeats = 3;
  plan_study(study);
  double seconds = 1;
  for (Trial& trial : study.trials) {
    const Trial measured = steady_trial(trial.key, {seconds, 1.01 * seconds, 1.02 * seconds}, 1000);
    const Work work = trial.work;
    trial = measured;
    trial.work = work;
    seconds *= 1.001;
  }
  return study;
}

Trial& trial_of_cell(Study& study, const char* table, const std::string& row, const std::string& column) {
  const std::string key = study.table(table)->find(row, column)->trial;
  return *std::find_if(study.trials.begin(), study.trials.end(), [&](const Trial& t) { return t.key == key; });
}

Conclusion conclusion_of(const Study& study, const std::string& title) {
  for (const Conclusion& conclusion : conclusions_of(study))
    if (conclusion.title == title) return conclusion;
  return {};
}

TEST(StudyConclusions, AreWithheldWhereOneOfTheirCellsIsInDoubt) {
  const Study quiet = measured_study();
  const std::pair<const char*, std::array<std::string, 3>> uses[] = {
      {"Precision.", {"table1", name::iterative, "double"}}, {"Schedule.", {"table3", "2 static", "float"}},
      {"Loops.", {"table2", "collapse", "float"}},           {"Threads.", {"table3", "12 dynamic", "float"}},
      {"Batches.", {"batches", "tiles", name::batches}},     {"Tree.", {"queries", name::binary_bvh, "float"}},
      {"Objects.", {"objects", "1000000", "linear scan"}},   {"Depth.", {"depth", "12", name::branching}},
      {"Glass.", {"glass", "11", name::branching}}};
  for (const auto& [title, cell] : uses) {
    EXPECT_FALSE(conclusion_of(quiet, title).text.empty()) << title;
    EXPECT_FALSE(conclusion_of(quiet, title).is_withheld) << title << conclusion_of(quiet, title).text;
    Study disturbed = measured_study();
    trial_of_cell(disturbed, cell[0].c_str(), cell[1], cell[2]).processor_fractions = {0.5, 0.5, 1};
    const Conclusion conclusion = conclusion_of(disturbed, title);
    EXPECT_TRUE(conclusion.is_withheld) << title;
    EXPECT_NE(conclusion.text.find("in 2 of 3 runs other programs used processors"), std::string::npos)
        << conclusion.text;
    EXPECT_NE(markdown_of(disturbed).find("Withheld: "), std::string::npos);
    EXPECT_FALSE(warnings_of(disturbed).empty());
  }
  EXPECT_TRUE(warnings_of(quiet).empty());
}

/// Speedups relate to one core: where that is in doubt, all of them are.
TEST(StudyConclusions, OfADisturbedBaselineAreWithheld) {
  Study study = measured_study();
  EXPECT_GT(headline_of(study).speedup, 0);
  trial_of_cell(study, "table1", name::iterative, "float").seconds = {1, 1.4, 1.5};
  EXPECT_TRUE(conclusion_of(study, "Schedule.").is_withheld);
  EXPECT_TRUE(conclusion_of(study, "Loops.").is_withheld);
  EXPECT_EQ(headline_of(study).speedup, 0);
  const std::string markdown = markdown_of(study);
  EXPECT_NE(markdown.find("its speedup relates to times of which this holds: repeats differ by"), std::string::npos);
  EXPECT_NE(csv_of(study).find("repeats differ by 36 %"), std::string::npos);
}

/// A schedule changes nothing but the balance of the threads: what that does not explain, something else did.
TEST(StudyConclusions, OfAScheduleMustBeExplainedByTheBalance) {
  Study study = measured_study();
  Trial& slow = trial_of_cell(study, "table3", "2 static", "float");
  for (double& seconds : slow.seconds) seconds *= 4.2;
  slow.busy_seconds.assign(3, {1.9, 0.1});
  EXPECT_TRUE(conclusion_of(study, "Schedule.").is_withheld);
  EXPECT_NE(conclusion_of(study, "Schedule.").text.find("explains a factor of 1.90 alone"), std::string::npos)
      << conclusion_of(study, "Schedule.").text;
  for (double& seconds : slow.seconds) seconds *= 1.9 / 4.2;
  EXPECT_FALSE(conclusion_of(study, "Schedule.").is_withheld);
  EXPECT_NE(conclusion_of(study, "Schedule.").text.find("as fast as a static one"), std::string::npos);
}

TEST(StudyConclusions, SayWhatDoesNotDiffer) {
  const Study study = measured_study();
  EXPECT_NE(conclusion_of(study, "Precision.").text.find("differ no more than their repeats do"), std::string::npos);
  EXPECT_NE(conclusion_of(study, "Loops.").text.find("differ no more than their repeats do"), std::string::npos);
}

/// Table 2 compares loops: all its forms take a path at a time, and so does what they relate to.
TEST(StudyPlan, ComparesLoopsByTheSameUnitOfWork) {
  const Study study = measured_study();
  for (const char* id : {"table1", "table2", "table3", "balance"})
    for (const Cell& cell : study.table(id)->cells) {
      const bool is_recursive = cell.row == name::recursive;  // by its own kernel, a path at a time as well
      EXPECT_TRUE(is_recursive || study.find(cell.trial)->work.queries == Queries::path_at_a_time) << cell.trial;
      EXPECT_EQ(study.find(cell.baseline)->work.queries, Queries::path_at_a_time) << cell.trial;
    }
}

TuneOutcome two_engines(const std::vector<double>& fast, const std::vector<double>& slow) {
  TuneOutcome outcome;
  outcome.is_complete = true;
  outcome.candidates.resize(3);
  for (Candidate& candidate : outcome.candidates) candidate.rounds = 4;
  outcome.candidates[0].costs = fast;
  outcome.candidates[1].costs = slow;
  outcome.candidates[2].costs = {1, 1, 1};  // in an earlier round
  outcome.candidates[2].rounds = 3;
  return outcome;
}

TEST(StudyTuneOutcome, IsStoredOnlyIfTheWinnerIsCertain) {
  EXPECT_EQ(why_not_to_store(two_engines({10, 11, 12}, {13, 14, 15})), "");
  EXPECT_NE(why_not_to_store(two_engines({10, 11, 14}, {13, 14, 15})).find("differ no more"), std::string::npos);
  TuneOutcome open = two_engines({10, 11, 12}, {13, 14, 15});
  open.is_complete = false;
  open.candidates[2].rounds = 4;
  EXPECT_NE(why_not_to_store(open).find("while 3 engines were left"), std::string::npos);
  TuneOutcome disturbed = two_engines({10, 11, 12}, {13, 14, 15});
  disturbed.candidates[1].disturbed = 2;
  EXPECT_NE(why_not_to_store(disturbed).find("in 2 of the last 3 runs"), std::string::npos);
}

TEST(StudyBuild, HasAnId) {
  EXPECT_EQ(build_id(), build_id());
  EXPECT_EQ(build_id().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_GE(build_id().size(), 16u);
}

TEST(StudyFigure1, IsOneDrawingWithoutOthers) {
  const std::string svg = figure1_svg();
  EXPECT_EQ(svg.find("<svg "), 0u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("href"), std::string::npos);
  for (const char* word : {"camera", "diffuse", "specular", "dielectric", "light", "at most D"})
    EXPECT_NE(svg.find(word), std::string::npos) << word;
}

}  // namespace
}  // namespace alhazen::impl::study
