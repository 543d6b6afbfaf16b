// The evaluation of a study's measurements: speedups, work per thread, the plan, resuming, comparing.

#include "study/study.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "backends/cuda/device_render.h"
#include "backends/cuda/host_executor.h"
#include "compile/compile_scene.h"
#include "io/pbrt/pbrt.h"
#include "study/compare.h"
#include "study/json.h"
#include "study/objects_scene.h"
#include "study/plan.h"
#include "study/plots.h"
#include "study/run_work.h"
#include "support/scenes.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::study {
namespace {

Trial trial_of(const std::string& key, std::vector<double> seconds, uint64_t samples, uint64_t rays) {
  Trial trial;
  trial.key = key;
  trial.status = TrialStatus::ok;
  trial.seconds = std::move(seconds);
  trial.busy_seconds.assign(trial.seconds.size(), {1.0, 3.0});
  trial.processor_fractions.assign(trial.seconds.size(), 1.0);
  trial.switches.assign(trial.seconds.size(), 0);
  trial.width = trial.height = 10;
  trial.samples_per_pixel = samples / 100;
  trial.samples = samples;
  trial.rays = rays;
  return trial;
}

/// A table of two cells over a baseline.
Study small_study(Measure measure = Measure::seconds) {
  Study study;
  study.machine.processor = "a processor";
  study.machine.version = "1";
  study.scene.hash = "0123";
  study.trials = {trial_of("slow", {4.9, 5, 5.1}, 1000, 3000), trial_of("fast", {1.02, 1.0, 0.98}, 2000, 3000)};
  Table table;
  table.id = "table3";
  table.measure = measure;
  table.columns = {"float"};
  table.cells = {{"one", "float", "slow", "slow", {}, ""}, {"two", "float", "fast", "slow", {}, ""}};
  study.tables.push_back(table);
  return study;
}

TEST(StudySpread, IsMedianWithSmallestAndLargest) {
  const Spread odd = spread_of({3, 1, 2}), even = spread_of({4, 1, 2, 10});
  EXPECT_EQ(odd.median, 2);
  EXPECT_EQ(odd.min, 1);
  EXPECT_EQ(odd.max, 3);
  EXPECT_EQ(even.median, 3);
}

TEST(StudySpeedup, IsOfTimePerSampleOrPerRay) {
  const Study by_sample = small_study();
  EXPECT_DOUBLE_EQ(speedup_of(by_sample, by_sample.tables[0], by_sample.tables[0].cells[1]), 10);
  const Study by_ray = small_study(Measure::nanoseconds_per_ray);
  EXPECT_DOUBLE_EQ(speedup_of(by_ray, by_ray.tables[0], by_ray.tables[0].cells[1]), 5);
}

TEST(StudySpeedup, IsNoneWhereAPartIsMissing) {
  Study study = small_study();
  study.trials[0].status = TrialStatus::failed;
  EXPECT_EQ(speedup_of(study, study.tables[0], study.tables[0].cells[1]), 0);
}

TEST(StudyBalance, OfThreads) {
  EXPECT_NEAR(gini({2, 2, 2, 2}), 0, 1e-12);
  EXPECT_NEAR(gini({0, 0, 0, 5}), 0.75, 1e-12);
  EXPECT_NEAR(gini({1, 3}), 0.25, 1e-12);
  const Trial trial = trial_of("a", {1, 1}, 100, 100);
  EXPECT_NEAR(busiest_over_mean(trial), 1.5, 1e-12);
  EXPECT_NEAR(gini_of_busy(trial), 0.25, 1e-12);
}

TEST(StudyWorkPerThread, IsTheSameInAllForAnyChunks) {
  const int width = 37, height = 23;
  std::vector<float> bounces(static_cast<size_t>(width * height));
  for (size_t i = 0; i < bounces.size(); ++i) bounces[i] = 1 + static_cast<float>(i * 7919 % 1000) / 125;
  const double all = std::accumulate(bounces.begin(), bounces.end(), 0.0);
  for (const auto& [x, y] : {std::pair{1, 1}, {4, 4}, {5, 3}, {37, 23}, {40, 2}}) {
    const ThreadGrid grid = threads_of(bounces, width, height, x, y);
    EXPECT_NEAR(grid.total(), all, 1e-9 * all) << x << " x " << y;
    EXPECT_NEAR(grid.mean(), all / static_cast<double>(bounces.size()), 1e-6) << x << " x " << y;
  }
}

/// The pixels of a thread are those that the CUDA backend's kernel assigns to it.
TEST(StudyWorkPerThread, HasThePixelsOfTheKernel) {
  const int width = 19, height = 14, chunks_x = 4, chunks_y = 3;
  const std::string film = "Film \"rgb\" \"integer xresolution\" 19 \"integer yresolution\" 14\nPixelFilter \"box\"\n";
  Diagnostics diagnostics;
  Scene scene = parse_pbrt(film + test::cornell_box, "cornell.pbrt", "", diagnostics);
  Settings asked;
  asked.samples_per_pixel = 4;
  const RenderSettings settings = resolve_settings(asked, scene);
  const CompiledScene<float> flat =
      compile_scene<float>(std::move(scene), {width, height, 1, {BvhLayout::bvh2}}, diagnostics);
  const ThreadGrid grid = threads_of(std::vector<float>(size_t{19 * 14}, 1.0f), width, height, chunks_x, chunks_y);
  for (uint32_t y = 0; y < static_cast<uint32_t>(grid.height); ++y)
    for (uint32_t x = 0; x < static_cast<uint32_t>(grid.width); ++x) {
      Film<float> rendered(settings.window, settings.aovs);
      cuda::Totals totals{};
      cuda::Launch<float> launch{flat.view, rendered.view(),   &totals,          0, 0, width,
                                 {},        {0, height, 0, 4}, settings.sampler, 0, 10};
      std::vector<BlockSum<float>> sums(static_cast<size_t>(grid.width * grid.height));
      const cuda::PixelKernel<cuda::Bvh2Tracing, IntegratorKind::iterative, float> kernel{launch, chunks_x, chunks_y,
                                                                                          sums.data()};
      kernel(cuda::HostThread(x, y, static_cast<uint32_t>(grid.width)));
      std::vector<float> taken;
      for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column)
          taken.push_back(rendered.samples_at(column, row) > 0 ? 1.0f : 0.0f);
      const ThreadGrid of_kernel = threads_of(taken, width, height, chunks_x, chunks_y);
      const size_t own = y * static_cast<size_t>(grid.width) + x;
      EXPECT_GT(of_kernel.segments[own], 0);
      for (size_t thread = 0; thread < grid.segments.size(); ++thread)
        EXPECT_EQ(of_kernel.segments[thread], thread == own ? grid.segments[own] : 0) << x << "," << y;
    }
}

TEST(StudyPlan, HasEveryFigureOfTheReport) {
  for (const int processors : {1, 2, 6, 64}) {
    Study study;
    study.machine.processors = processors;
    study.scene.width = study.scene.height = 800;
    study.scene.spheres = 1006;
    plan_study(study);
    std::map<std::string, size_t> figures;
    for (const Table& table : study.tables)
      for (const Cell& cell : table.cells) {
        figures[table.id] += cell.report.size();
        EXPECT_NE(study.find(cell.trial), nullptr);
        EXPECT_TRUE(cell.baseline.empty() || study.find(cell.baseline)) << table.id;
      }
    EXPECT_EQ(figures["table1"], 4u);
    EXPECT_EQ(figures["table2"], 4u);
    EXPECT_EQ(figures["table3"], 24u);
    EXPECT_EQ(figures["table4"], 16u);
    EXPECT_EQ(figures["table5"], 32u);
    EXPECT_EQ(figures["optix"], 1u);
    EXPECT_NE(study.table("table3")->find(std::to_string(processors) + " guided", "double"), nullptr);
  }
}

TEST(StudyPlan, MeasuresTheSameWorkOnce) {
  Study study;
  study.machine.processors = 2;
  study.scene.width = study.scene.height = 800;
  study.scene.spheres = 1006;
  plan_study(study);
  const Cell* in_table2 = study.table("table2")->find("rows (simple)", "float");
  const Cell* in_table3 = study.table("table3")->find("2 dynamic", "float");
  EXPECT_EQ(in_table2->trial, in_table3->trial);
  std::set<std::string> keys;
  for (const Trial& trial : study.trials) EXPECT_TRUE(keys.insert(trial.key).second) << trial.key;
}

TEST(StudyQueries, TraceTheSamePathsAsTheBackends) {
  const Scene no_scene;
  for (const bool is_glass : {false, true})
    for (const char* precision : {"float", "double"}) {
      Work work;
      work.objects = 60;
      work.is_glass = is_glass;
      work.settings.backend = "serial";
      work.settings.precision = precision;
      work.settings.integrator = "iterative";
      work.settings.width = work.settings.height = 24;
      work.settings.samples_per_pixel = 8;
      const GoOn always = [] { return true; };
      const Outcome backend = run_work(work, no_scene, false, always);
      ASSERT_EQ(backend.status, TrialStatus::ok) << backend.reason;
      EXPECT_GT(backend.statistics.rays, backend.statistics.camera_samples);
      for (const Queries queries : {Queries::path_at_a_time, Queries::linear_scan, Queries::binary_bvh}) {
        work.queries = queries;
        const Outcome outcome = run_work(work, no_scene, false, always);
        ASSERT_EQ(outcome.status, TrialStatus::ok) << outcome.reason;
        EXPECT_EQ(outcome.statistics.rays, backend.statistics.rays);
        EXPECT_EQ(outcome.statistics.camera_samples, backend.statistics.camera_samples);
        EXPECT_GT(outcome.statistics.render_seconds, 0);
      }
    }
}

/// Every form of the loops, in batches and a path at a time, at an S that is no multiple of a block.
TEST(StudyQueries, GiveTheSameBitsAPathAtATime) {
  const Scene no_scene;
  const GoOn always = [] { return true; };
  for (const char* precision : {"float", "double"}) {
    std::optional<Image> reference;
    for (const std::string strategy : {"", "rows", "collapse", "rows+reduction", "reduction", "tiles"})
      for (const Queries queries : {Queries::of_backend, Queries::path_at_a_time}) {
        Work work;
        work.objects = 60;
        work.queries = queries;
        work.settings.backend = strategy.empty() ? "serial" : "openmp";
        work.settings.strategy = strategy;
        if (!strategy.empty()) work.settings.threads = 3;
        work.settings.precision = precision;
        work.settings.integrator = "iterative";
        work.settings.width = work.settings.height = 24;
        work.settings.samples_per_pixel = 22;
        const Outcome outcome = run_work(work, no_scene, true, always);
        ASSERT_EQ(outcome.status, TrialStatus::ok) << outcome.reason;
        if (!reference) reference = outcome.image;
        EXPECT_EQ(outcome.image->planes, reference->planes) << command_options(work);
        EXPECT_EQ(outcome.statistics.camera_samples, 24u * 24 * 22) << command_options(work);
      }
  }
}

TEST(StudyWork, SaysWhyItCannotBeDone) {
  Work work;
  work.objects = 10;
  work.settings.backend = "cuda";
  work.settings.device = "77";
  const Scene no_scene;
  const Outcome outcome = run_work(work, no_scene, false, [] { return true; });
  EXPECT_EQ(outcome.status, TrialStatus::unavailable);
  EXPECT_FALSE(outcome.reason.empty());
  EXPECT_EQ(outcome.reason.find('\n'), std::string::npos);
}

TEST(StudyResume, KeepsWhatWasMeasuredAndNotWhatWasDisturbed) {
  Study earlier = small_study();
  earlier.trials[1].processor_fractions = {1, 0.5, 1};
  Study study = small_study();
  for (Trial& trial : study.trials) {
    const std::string key = trial.key;
    trial = {};
    trial.key = key;
  }
  resume_from(nlohmann::json::parse(to_json(earlier).dump()), "study.json", study);
  EXPECT_EQ(study.trials[0].seconds, (std::vector<double>{4.9, 5, 5.1}));
  EXPECT_EQ(study.trials[1].seconds, (std::vector<double>{1.02, 0.98}));
  EXPECT_EQ(study.trials[1].rays, 3000u);
}

/// Parts that are not measured now, with `--only`.
TEST(StudyResume, KeepsAllOfTheTrialsThatAreNotAskedFor) {
  Study earlier = small_study();
  earlier.trials[0].processor_fractions = {0.5, 1, 0.5};
  earlier.trials[0].disturbed_seconds = {7};
  earlier.trials[1] = {};
  earlier.trials[1].key = "fast";
  earlier.trials[1].status = TrialStatus::unavailable;
  earlier.trials[1].reason = "no GPU";
  Study study = small_study();
  for (Trial& trial : study.trials) {
    const std::string key = trial.key;
    trial = {};
    trial.key = key;
    trial.is_asked = false;
  }
  const std::string before = to_json(earlier)["trials"].dump();
  resume_from(nlohmann::json::parse(to_json(earlier).dump()), "study.json", study);
  EXPECT_EQ(to_json(study)["trials"].dump(), before);
}

TEST(StudyResume, RefusesAnotherSceneAndWhatIsDamaged) {
  const nlohmann::json earlier = nlohmann::json::parse(to_json(small_study()).dump());
  Study other = small_study();
  other.scene.hash = "4567";
  EXPECT_THROW(resume_from(earlier, "study.json", other), InputError);
  other = small_study();
  other.scale.samples += 1;
  EXPECT_THROW(resume_from(earlier, "study.json", other), InputError);
  other = small_study();
  other.machine.build = "another";
  try {
    resume_from(earlier, "study.json", other);
    FAIL() << "another build";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("another build of the program"), std::string::npos) << error.what();
  }
  nlohmann::json damaged = earlier;
  damaged["trials"][0]["seconds"] = "none";
  Study same = small_study();
  EXPECT_THROW(resume_from(damaged, "study.json", same), InputError);
}

/// As in studies that were interrupted after a first, disturbed run.
nlohmann::json without_seconds(size_t trial) {
  nlohmann::json j = nlohmann::json::parse(to_json(small_study()).dump());
  j["trials"][trial] = {{"key", j["trials"][trial]["key"]}, {"status", "ok"}};
  j["tables"][0]["cells"][trial].erase("seconds");
  return j;
}

TEST(StudyResume, MeasuresAgainWhatHasNoTimes) {
  Study study = small_study();
  for (Trial& trial : study.trials) {
    const std::string key = trial.key;
    trial = {};
    trial.key = key;
  }
  resume_from(without_seconds(1), "study.json", study);
  EXPECT_EQ(study.trials[0].status, TrialStatus::ok);
  EXPECT_EQ(study.trials[1].status, TrialStatus::not_run);
  // If all runs were disturbed, none is kept, and the trial counts as not run.
  Study earlier = small_study();
  earlier.trials[0].processor_fractions = {0.5, 0.5, 0.5};
  study.trials[0] = {};
  study.trials[0].key = earlier.trials[0].key;
  resume_from(nlohmann::json::parse(to_json(earlier).dump()), "study.json", study);
  EXPECT_EQ(study.trials[0].status, TrialStatus::not_run);
  for (const auto& trial : to_json(study)["trials"])
    EXPECT_EQ(trial["status"] == "ok", trial.contains("seconds")) << trial.dump();
}

TEST(StudyCompare, LeavesOutWhatHasNoTimes) {
  const nlohmann::json whole = nlohmann::json::parse(to_json(small_study()).dump());
  const StudyComparison comparison = compare_studies(whole, without_seconds(1), 0.05, "a", "b");
  EXPECT_EQ(comparison.compared, 1u);
  ASSERT_EQ(comparison.states.size(), 1u);
  EXPECT_NE(comparison.states[0].find("not run"), std::string::npos);
}

TEST(StudyRead, TakesTheFolder) {
  test::TemporaryFolder folder;
  const auto error_of = [](const std::string& path) {
    try {
      read_study_json(path);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(error_of(folder.path()).find("no study.json in this folder"), std::string::npos);
  EXPECT_NE(error_of(folder.file("none")).find("no such file"), std::string::npos);
  EXPECT_NE(error_of("/dev/zero").find("is a device"), std::string::npos);
  folder.write_text("study.json", to_json(small_study()).dump());
  EXPECT_EQ(read_study_json(folder.path()), read_study_json(folder.file("study.json")));
}

/// Drawn by Python if it has matplotlib.
TEST(StudyPlots, OfStudiesThatWereInterrupted) {
  test::TemporaryFolder folder;
  Study study = small_study();
  for (const char* id : {"table1", "table2", "table3", "table4", "table5", "balance", "batches", "queries", "depth",
                         "glass", "objects", "error", "engines", "optix"}) {
    Table table = study.tables[0];
    table.id = id;
    const std::string schedule = table.id == "table3" ? " static" : "";
    table.cells[0].row = "1" + schedule;
    table.cells[1].row = "2" + schedule;
    study.tables.push_back(table);
  }
  // The slowest repeat is the median: the difference of their speedups may be rounded to either side of 0.
  study.trials[0].seconds = {0.1, 0.3};
  study.trials[1].seconds = {0.7, 0.7, 0.7};
  study.trials[1].busy_seconds.resize(3, {1.0});
  nlohmann::json j = nlohmann::json::parse(to_json(study).dump());
  for (size_t table = 0; table < j["tables"].size(); ++table) {
    nlohmann::json& cells = j["tables"][table]["cells"];
    cells[0]["speedup"] = cells[1]["speedup"] = 1.7;
    cells[table % 2].erase(table % 3 == 0 ? "seconds" : "speedup");
  }
  folder.write_text("study.json", j.dump());
  const std::string problem = draw_plots(folder.path());
  if (problem.find("no Python with matplotlib") != std::string::npos) GTEST_SKIP() << problem;
  EXPECT_EQ(problem, "");
}

TEST(StudyCompare, TellsWhatIsBeyondNoise) {
  const nlohmann::json a = nlohmann::json::parse(to_json(small_study()).dump());
  Study later = small_study();
  later.trials[1].seconds = {2.0, 2.1, 1.9};
  const nlohmann::json b = nlohmann::json::parse(to_json(later).dump());
  EXPECT_TRUE(compare_studies(a, a, 0.05, "a", "a").changes.empty());
  const StudyComparison comparison = compare_studies(a, b, 0.05, "a", "b");
  EXPECT_EQ(comparison.compared, 2u);
  ASSERT_EQ(comparison.changes.size(), 1u);
  EXPECT_EQ(comparison.changes[0].row, "two");
  EXPECT_NEAR(comparison.changes[0].ratio(), 2, 1e-12);
  EXPECT_TRUE(comparison.differences.empty());
  later.trials[1].seconds = {1.01, 2.1, 1.9};  // one repeat is as fast as before
  EXPECT_TRUE(compare_studies(a, nlohmann::json::parse(to_json(later).dump()), 0.05, "a", "b").changes.empty());
  EXPECT_TRUE(compare_studies(a, b, 1.5, "a", "b").changes.empty());  // below the threshold
}

TEST(StudyCompare, TellsOtherMachinesAndCellsThatAreGone) {
  const nlohmann::json a = nlohmann::json::parse(to_json(small_study()).dump());
  Study later = small_study();
  later.machine.processor = "another";
  later.trials[1].status = TrialStatus::unavailable;
  later.trials[1].reason = "gone";
  const StudyComparison comparison = compare_studies(a, nlohmann::json::parse(to_json(later).dump()), 0.05, "a", "b");
  ASSERT_EQ(comparison.differences.size(), 1u);
  EXPECT_NE(comparison.differences[0].find("another"), std::string::npos);
  ASSERT_EQ(comparison.states.size(), 1u);
  EXPECT_NE(comparison.states[0].find("gone"), std::string::npos);
  EXPECT_THROW(compare_studies(a, nlohmann::json::object(), 0.05, "a", "b"), InputError);
}

TEST(StudyClouds, AreTheSameForTheSameNumber) {
  const Scene a = cloud_of_spheres(100, false), b = cloud_of_spheres(100, false);
  ASSERT_EQ(a.groups[0].shapes.size(), 100u);
  for (size_t i = 0; i < 100; ++i) {
    EXPECT_TRUE(a.groups[0].shapes[i].world_from_object.start == b.groups[0].shapes[i].world_from_object.start);
    EXPECT_NEAR(a.groups[0].shapes[i].radius, 0.12, 1e-12);
  }
}

}  // namespace
}  // namespace alhazen::impl::study
