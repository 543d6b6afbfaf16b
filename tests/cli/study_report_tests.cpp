// The subcommands `alhazen study report` and `alhazen study compare`.

#include <sys/stat.h>

#include <cmath>
#include <map>
#include <set>

#include "cli/study_fixture.h"

namespace alhazen::impl::test {

namespace {

using StudyReport = StudyCommand;

/// The trials of a study by their keys.
std::map<std::string, nlohmann::json> trials_of(const nlohmann::json& study) {
  std::map<std::string, nlohmann::json> trials;
  for (const nlohmann::json& trial : study["trials"]) trials[trial["key"]] = trial;
  return trials;
}

double cost_of(const nlohmann::json& trial, const char* unit) {
  const double units = unit == std::string("rays") ? trial["rays"].get<double>() + trial["shadow_rays"].get<double>()
                                                   : trial[unit].get<double>();
  std::vector<double> seconds = trial["seconds"]["samples"];
  std::sort(seconds.begin(), seconds.end());
  const size_t n = seconds.size();
  return (n % 2 == 1 ? seconds[n / 2] : (seconds[n / 2 - 1] + seconds[n / 2]) / 2) / units;
}

/// Three significant digits, as in tables: 0.0123, 0.512, 12.3, 4533.
std::string three_digits(double value) {
  const int digits = value >= 100  ? 0
                     : value >= 10 ? 1
                     : value >= 1  ? 2
                                   : 2 - static_cast<int>(std::floor(std::log10(value)));
  char buffer[32];
  std::snprintf(buffer, sizeof(buffer), "%.*f", digits, value);
  return buffer;
}

TEST_F(StudyReport, SpeedupsOfAllTablesAreThoseOfTheTimes) {
  without_plots();
  const CommandResult result =
      report({"--output", "out", "--only", "table1,table2,table3,table4,optix,engines,batches,queries,balance"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  const nlohmann::json study = json("out/study.json");
  EXPECT_EQ(study["schema"], "alhazen-study-1");
  EXPECT_EQ(study["complete"], true);
  const auto trials = trials_of(study);
  const std::string markdown = text("out/tables.md"), csv = text("out/tables.csv"), page = text("out/index.html");
  size_t speedups = 0, rows = 0;
  for (const nlohmann::json& table : study["tables"])
    for (const nlohmann::json& cell : table["cells"]) {
      ++rows;
      if (cell["status"] != "ok") {
        EXPECT_FALSE(cell.value("reason", "").empty()) << cell;
        EXPECT_NE(markdown.find(cell["reason"].get<std::string>()), std::string::npos);
        continue;
      }
      const nlohmann::json& trial = trials.at(cell["trial"]);
      EXPECT_EQ(trial["seconds"]["samples"].size(), 2u);
      ASSERT_TRUE(cell.contains("speedup")) << cell;
      const char* unit = table["measure"] == "nanoseconds per ray" ? "rays" : "camera_samples";
      const double expected = cost_of(trials.at(cell["baseline"]), unit) / cost_of(trial, unit);
      EXPECT_NEAR(cell["speedup"].get<double>(), expected, 1e-9 * expected) << cell;
      EXPECT_NE(markdown.find("| " + three_digits(expected) + "x |"), std::string::npos) << cell;
      EXPECT_NE(page.find(">" + three_digits(expected) + "x</span>"), std::string::npos) << cell;
      ++speedups;
    }
  EXPECT_GT(speedups, 30u);
  EXPECT_EQ(lines_of(csv).size(), rows + 1);
  for (const char* id : {"table1", "table2", "table3", "balance"}) {
    const auto table = std::find_if(study["tables"].begin(), study["tables"].end(),
                                    [&](const nlohmann::json& t) { return t["id"] == id; });
    ASSERT_NE(table, study["tables"].end());
    for (const nlohmann::json& cell : (*table)["cells"]) EXPECT_EQ(cell["status"], "ok") << cell;
  }
}

TEST_F(StudyReport, Figure3KeepsTheWorkAndLevelsIt) {
  without_plots();
  folder_.write_text("scene.pbrt", std::string("Film \"rgb\" \"integer xresolution\" 90 \"integer yresolution\" 70\n"
                                               "LookAt 0 1 4  0 0.6 0  0 1 0\nCamera \"perspective\" \"float fov\" 50\n"
                                               "Integrator \"path\" \"integer maxdepth\" 9\nWorldBegin\n"
                                               "Shape \"sphere\" \"float radius\" 0.6\n"
                                               "Material \"dielectric\"\nTranslate 1 0 0.6\n"
                                               "Shape \"sphere\" \"float radius\" 0.5\nTranslate -1 -1000.6 0\n"
                                               "Material \"diffuse\"\nShape \"sphere\" \"float radius\" 1000\n"));
  const CommandResult result = report({"--output", "out", "--only", "figure2,figure3"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  const nlohmann::json figure = json("out/study.json")["figure3"];
  EXPECT_EQ(image("out/figure2.png").width, 90);
  const Image naive = image("out/figure3-naive.pfm"), chunked = image("out/figure3-chunked.pfm");
  EXPECT_EQ(naive.width, 90);
  EXPECT_EQ(chunked.width, 23);
  EXPECT_EQ(chunked.height, 18);
  double sum = 0, largest = 0;
  for (const float value : naive.planes[0]) {
    sum += static_cast<double>(value);
    largest = std::max(largest, static_cast<double>(value));
  }
  const double mean = sum / (90 * 70);
  EXPECT_NEAR(mean, figure["statistic_mean"].get<double>(), 1e-5 * mean);
  EXPECT_NEAR(mean, figure["naive"]["mean"].get<double>(), 1e-5 * mean);
  EXPECT_NEAR(largest, figure["naive"]["largest"].get<double>(), 1e-5);
  EXPECT_NEAR(figure["naive"]["total"].get<double>(), figure["chunked"]["total"].get<double>(), 1e-6 * sum);
  EXPECT_NEAR(figure["chunked"]["mean"].get<double>(), mean, 1e-5 * mean);
  EXPECT_GT(figure["naive"]["largest"].get<double>(), 1.5 * figure["chunked"]["largest"].get<double>());
  EXPECT_GT(figure["naive"]["gini"].get<double>(), figure["chunked"]["gini"].get<double>());
}

/// The report's own scene: the result of its Figure 3, at a small size.
TEST_F(StudyReport, Figure3OfTheSpheres) {
  without_plots();
  const CommandResult result = run({"study", "report", "--quick", "--scene", ALHAZEN_SOURCE_DIR "/scenes/spheres.pbrt",
                                    "--only", "figure3", "--output", "out"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  const nlohmann::json figure = json("out/study.json")["figure3"];
  EXPECT_NEAR(figure["naive"]["mean"].get<double>(), 2.40, 0.01);
  EXPECT_GT(figure["naive"]["largest"].get<double>(), 9);
  EXPECT_LT(figure["chunked"]["largest"].get<double>(), 3.5);
}

TEST_F(StudyReport, RefusesWhatItCannotDo) {
  without_plots();
  ASSERT_EQ(report({"--output", "out", "--only", "table1", "-q"}).exit_code, 0);
  const std::string before = text("out/study.json");
  const std::vector<std::vector<std::string>> cases{
      {"--output", "out", "--only", "table1"},                            // a study exists
      {"--output", "out", "--resume", "--overwrite"},                     //
      {"--output", "other", "--resume"},                                  // no study exists
      {"--output", "other", "--only", "table9"},                          //
      {"--output", "scene.pbrt"},                                         // not a folder
      {"--output", "other", "--full"},                                    // with --quick
      {"--output", "other", "--scene", "missing.pbrt"},                   //
      {"--output", "other", "--repeats", "0"},                            //
      {"--output", "out", "--only", "table1", "--resume", "--spp", "x"},  //
  };
  for (const std::vector<std::string>& arguments : cases) {
    const CommandResult result = report(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.everything();
    EXPECT_FALSE(result.err.empty());
  }
  EXPECT_EQ(text("out/study.json"), before);
  EXPECT_FALSE(exists("other"));
  folder_.write_text("out/study.json", "{\"schema\": \"alhazen-study-1\"}");
  EXPECT_EQ(report({"--output", "out", "--only", "table1", "--resume"}).exit_code, 2);
}

/// Whether a run is among those of a trial, or among those that others have replaced.
bool holds_run(const nlohmann::json& trial, const nlohmann::json& seconds) {
  for (const nlohmann::json& list : {trial["seconds"]["samples"], trial.value("disturbed_seconds", nlohmann::json())})
    for (const nlohmann::json& run : list)
      if (run == seconds) return true;
  return false;
}

/// A study that is killed loses at most two seconds of it.
TEST_F(StudyReport, InterruptedItKeepsWhatItHasAndGoesOn) {
  without_plots();
  for (const std::string signal : {"INT", "KILL"}) {
    std::filesystem::remove_all(folder_.file("out"));
    CommandOptions options;
    options.folder = folder_.path();
    const CommandResult interrupted = run_script(
        "$ALHAZEN study report --quick --scene scene.pbrt --size 250 --spp 4 --repeats 2 -o out --only table1 "
        "2>err & p=$!\nfor i in $(seq 1200); do test -e out/study.json && break; sleep 0.05; done\n"
        "kill -" +
            signal + " $p; wait $p; echo $?",
        options);
    EXPECT_EQ(interrupted.out, signal == "INT" ? "130\n" : "137\n") << interrupted.everything() << text("err");
    const nlohmann::json first = json("out/study.json");
    EXPECT_EQ(first["complete"], false);
    EXPECT_LT(first["runs"]["measured"], first["runs"]["planned"]);
    if (signal == "INT") {
      for (const char* file : {"out/tables.md", "out/index.html"})
        EXPECT_NE(text(file).find("this study is incomplete, "), std::string::npos) << file;
    }
    // Another size is another study; the same command goes on.
    const std::vector<std::string> again{"--output", "out", "--only", "table1"};
    const CommandResult other = report(again, {}, "150");
    EXPECT_EQ(other.exit_code, 2) << other.everything();
    EXPECT_NE(other.err.find("width: 250, now 150"), std::string::npos) << other.err;
    const CommandResult resumed = report(again, {}, "250");
    EXPECT_EQ(resumed.exit_code, 0) << resumed.everything();
    EXPECT_NE(resumed.err.find("continuing the study in out: "), std::string::npos) << resumed.err;
    const nlohmann::json second = json("out/study.json");
    EXPECT_EQ(second["complete"], true);
    EXPECT_EQ(second["runs"]["measured"], second["runs"]["planned"]);
    EXPECT_EQ(text("out/tables.md").find("incomplete"), std::string::npos);
    const auto after = trials_of(second);
    for (const auto& [key, trial] : trials_of(first)) {
      EXPECT_EQ(after.at(key)["seconds"]["samples"].size(), 2u) << key;
      const bool has_one = trial.contains("seconds") && trial["seconds"]["samples"].size() == 1;
      if (!has_one || trial["processor_shares"][0] < 0.9) continue;
      EXPECT_TRUE(holds_run(after.at(key), trial["seconds"]["samples"][0])) << key;
    }
  }
}

/// Two other programs for each processor take more than half of it.
TEST_F(StudyReport, OtherProgramsAreNoticed) {
  without_plots();
  CommandOptions options;
  options.folder = folder_.path();
  const CommandResult result = run_script(
      "for i in $(seq $((2 * $(nproc)))); do (while :; do :; done) & load=\"$load $!\"; done\n"
      "$ALHAZEN study report --quick --scene scene.pbrt --size 64 --spp 8 --repeats 2 -o out --only table1 2>err\n"
      "echo $?; kill $load",
      options);
  EXPECT_EQ(result.out, "0\n") << result.everything() << text("err");
  EXPECT_NE(text("err").find("warning: the times of 4 of 4 works are not those of the machine alone"),
            std::string::npos)
      << text("err");
  const nlohmann::json study = json("out/study.json");
  for (const nlohmann::json& cell : study["tables"][0]["cells"]) EXPECT_FALSE(cell.value("doubt", "").empty()) << cell;
  for (const nlohmann::json& trial : study["trials"]) {
    EXPECT_EQ(trial["seconds"]["samples"].size(), 2u) << trial;
    EXPECT_EQ(trial["disturbed_seconds"].size(), 2u) << trial;
    EXPECT_GT(trial["involuntary_switches"][0], 0) << trial;
  }
  for (const char* file : {"out/tables.md", "out/index.html"})
    EXPECT_NE(text(file).find("Withheld: table1, iterative (Algorithm 5), float: "), std::string::npos) << file;
}

TEST_F(StudyReport, WithoutPythonThereIsAllButPlots) {
  without_plots();
  const CommandResult result = report({"--output", "out", "--only", "table2,figure3"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_NE(result.err.find("python3-matplotlib"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("complete without them"), std::string::npos) << result.err;
  EXPECT_FALSE(exists("out/figure3.png"));
  for (const char* file : {"study.json", "tables.csv", "tables.md", "index.html", "figure1.svg", "figure3-naive.pfm"})
    EXPECT_TRUE(exists(std::string("out/") + file)) << file;
}

/// As on a full disk: no file can grow beyond this size.
TEST_F(StudyReport, WhatCannotBeWrittenIsToldInLines) {
  without_plots();
  CommandOptions options;
  options.file_size = 100;
  const CommandResult result = report({"--output", "out", "--only", "table2"}, options);
  EXPECT_EQ(result.exit_code, 1) << result.everything();
  EXPECT_NE(result.err.find("study.json"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("\ncannot write out/tables.md"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("\\n"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("complete without them"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("no plots: cannot write"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("SyntaxError"), std::string::npos) << result.err;
}

/// study.json alone marks a folder as a study's.
TEST_F(StudyReport, FilesOfTheUserAreNotTouched) {
  without_plots();
  for (const std::string name :
       {"glass.png", "objects.svg", "figure2.png", "figure3-naive.pfm", "index.html", "tables.csv", "tables.md"}) {
    std::filesystem::create_directory(folder_.file("mine"));
    folder_.write_text("mine/" + name, "mine");
    for (const char* further : {"-q", "--overwrite"}) {
      const CommandResult result = report({"--output", "mine", "--only", "figure2", further});
      EXPECT_EQ(result.exit_code, 2) << result.everything();
      EXPECT_EQ(result.err.find("mine/" + name + ": "), 0u) << result.err;
      EXPECT_NE(result.err.find("give another --output"), std::string::npos) << result.err;
      EXPECT_EQ(text("mine/" + name), "mine");
    }
    EXPECT_FALSE(exists("mine/study.json"));
    std::filesystem::remove_all(folder_.file("mine"));
  }
  // Another program's file of that name.
  std::filesystem::create_directory(folder_.file("mine"));
  for (const char* other : {"{\"schema\": 3}", "[]", "no JSON"}) {
    folder_.write_text("mine/study.json", other);
    EXPECT_EQ(report({"--output", "mine", "--only", "table1", "--overwrite"}).exit_code, 2);
    EXPECT_EQ(text("mine/study.json"), other);
  }
}

TEST_F(StudyReport, FilesOfTheSceneAreNotTouched) {
  without_plots();
  ASSERT_EQ(report({"--output", "out", "--only", "table1", "-q"}).exit_code, 0);
  for (const std::string name : {"index.html", "depth.png"}) {
    folder_.write_text("out/" + name, "# a part of the scene\n");
    folder_.write_text("scene.pbrt", "Include \"out/" + name + "\"\n" + cornell_box(24));
    for (const char* further : {"--resume", "--overwrite"}) {
      const CommandResult result = report({"--output", "out", "--only", "table1", further});
      EXPECT_EQ(result.exit_code, 2) << result.everything();
      EXPECT_NE(result.err.find("that the scene is read from"), std::string::npos) << result.err;
      EXPECT_EQ(text("out/" + name), "# a part of the scene\n");
    }
  }
}

/// A pipe would wait for a reader.
TEST_F(StudyReport, WhatIsNoFileIsNotReplaced) {
  without_plots();
  ASSERT_EQ(report({"--output", "out", "--only", "table1", "-q"}).exit_code, 0);
  std::filesystem::remove(folder_.file("out/index.html"));
  ASSERT_EQ(mkfifo(folder_.file("out/index.html").c_str(), 0600), 0);
  const CommandResult result = report({"--output", "out", "--only", "table1", "--resume"});
  EXPECT_EQ(result.exit_code, 2) << result.everything();
  EXPECT_EQ(result.err.find("out/index.html: this is not a file"), 0u) << result.err;
}

TEST_F(StudyReport, FoldersThatCannotBeUsed) {
  without_plots();
  std::filesystem::create_symlink("loop", folder_.file("loop"));
  for (const std::string& folder :
       {std::string("loop"), std::string(300, 'x'), std::string(), std::string("scene.pbrt"), std::string("loop/out"),
        std::string("scene.pbrt/out"), std::string("/dev/null")}) {
    const CommandResult result = report({"--output", folder, "--only", "table1"});
    EXPECT_EQ(result.exit_code, 2) << folder << result.everything();
    EXPECT_NE(result.err.find("--output"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("filesystem error"), std::string::npos) << result.err;
  }
}

TEST_F(StudyReport, WithoutAFolderForTemporaryFilesThereIsAllButPlots) {
  without_plots();
  std::filesystem::create_symlink("loop", folder_.file("loop"));
  for (const std::string& folder : {std::string("/nonexistent"), std::string(), std::string("/dev/null"),
                                    folder_.file("scene.pbrt"), folder_.file("loop"), std::string(300, 'x')}) {
    set("TMPDIR", folder);
    const CommandResult result = report({"--output", "out", "--only", "table1", "--overwrite"});
    unsetenv("TMPDIR");
    EXPECT_EQ(result.exit_code, 0) << folder << result.everything();
    EXPECT_NE(result.err.find("no plots: there is no folder for temporary files (TMPDIR)"), std::string::npos)
        << result.err;
    EXPECT_TRUE(exists("out/index.html"));
    std::filesystem::remove(folder_.file("out/index.html"));
  }
}

/// The plots of the same study are kept, those of a replaced one are not.
TEST_F(StudyReport, APlotIsReplacedOnlyByItsSuccessor) {
  without_plots();
  ASSERT_EQ(report({"--output", "out", "--only", "table1", "-q"}).exit_code, 0);
  folder_.write_text("out/glass.png", "a plot");
  folder_.write_text("out/depth.svg", "a plot");
  const std::vector<std::string> resume{"--output", "out", "--only", "table1", "--resume", "-q"};
  EXPECT_EQ(report(resume).exit_code, 0);
  EXPECT_EQ(text("out/glass.png"), "a plot");
  // The third argument is the folder to draw into.
  use_as_python("test $1 = -c && exit\necho new >$3/depth.svg; echo no more plots; exit 1");
  const CommandResult failed = report(resume);
  EXPECT_NE(failed.err.find("no more plots"), std::string::npos) << failed.err;
  EXPECT_EQ(text("out/glass.png"), "a plot");
  EXPECT_EQ(text("out/depth.svg"), "new\n");
  EXPECT_EQ(report({"--output", "out", "--only", "table1", "--overwrite", "-q"}).exit_code, 0);
  EXPECT_FALSE(exists("out/glass.png"));
  EXPECT_EQ(text("out/depth.svg"), "new\n");
}

TEST_F(StudyReport, ResumingAPartKeepsTheOthers) {
  without_plots();
  ASSERT_EQ(report({"--output", "out", "--only", "table1,figure2,figure3", "-q"}).exit_code, 0);
  const nlohmann::json before = json("out/study.json");
  const std::string figure2 = text("out/figure2.png");
  const CommandResult result = report({"--output", "out", "--only", "table2", "--resume", "-q"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  const nlohmann::json after = json("out/study.json");
  EXPECT_EQ(after["complete"], true);
  ASSERT_EQ(after["tables"].size(), 2u);
  EXPECT_EQ(after["figure3"], before["figure3"]);
  EXPECT_EQ(text("out/figure2.png"), figure2);
  const auto old_trials = trials_of(before), trials = trials_of(after);
  std::set<std::string> measured;
  for (const nlohmann::json& cell : after["tables"][1]["cells"]) {
    measured.insert(cell["trial"].get<std::string>());
    measured.insert(cell.value("baseline", ""));
  }
  size_t kept = 0;
  for (const auto& [key, trial] : old_trials) {
    ASSERT_TRUE(trials.contains(key)) << key;
    if (measured.contains(key)) continue;
    EXPECT_EQ(trials.at(key), trial);
    ++kept;
  }
  EXPECT_GT(kept, 1u);
  EXPECT_NE(text("out/tables.md").find("recursive (Algorithm 3)"), std::string::npos);
  // Images of another size are other trials.
  const std::string now = text("out/study.json");
  EXPECT_EQ(report({"--output", "out", "--only", "table2", "--resume"}, {}, "17").exit_code, 2);
  EXPECT_EQ(text("out/study.json"), now);
}

TEST_F(StudyReport, InterruptedAtOnceItReplacesNothing) {
  without_plots();
  CommandOptions options;
  options.signal_when = [](const std::string& err) { return err.find("round 1 of") != std::string::npos ? SIGINT : 0; };
  const std::vector<std::string> arguments{"--output", "out", "--only", "table1,figure2,figure3", "--overwrite"};
  const CommandResult in_new_folder = report(arguments, options, "800");
  EXPECT_EQ(in_new_folder.exit_code, 130) << in_new_folder.everything();
  EXPECT_FALSE(exists("out"));
  ASSERT_EQ(report({"--output", "out", "--only", "table2,figure2", "-q"}).exit_code, 0);
  const std::string study = text("out/study.json"), page = text("out/index.html"), figure2 = text("out/figure2.png");
  const CommandResult result = report(arguments, options, "800");
  EXPECT_EQ(result.exit_code, 130) << result.everything();
  EXPECT_NE(result.err.find("before the first measurement: nothing is written"), std::string::npos) << result.err;
  EXPECT_EQ(text("out/study.json"), study);
  EXPECT_EQ(text("out/index.html"), page);
  EXPECT_EQ(text("out/figure2.png"), figure2);
  EXPECT_FALSE(exists("out/figure3-naive.pfm"));
}

/// The program that draws ends too, and nothing temporary stays.
TEST_F(StudyReport, InterruptedWhileDrawingItWritesThePage) {
  use_as_python("test $1 = -c && exit\necho $$ >started; exec sleep 100");
  CommandOptions options;
  options.folder = folder_.path();
  const CommandResult result = run_script(
      "mkdir tmp; export TMPDIR=$PWD/tmp\n"
      "$ALHAZEN study report --quick --scene scene.pbrt --size 16 --spp 4 --repeats 1 --only table1 -o out 2>err & "
      "p=$!\n"
      "for i in $(seq 1200); do test -s started && break; sleep 0.05; done\n"
      "kill -INT $p; wait $p; echo $?; ls tmp; kill -0 $(cat started) 2>/dev/null && echo still there",
      options);
  EXPECT_EQ(result.out, "130\n") << result.everything() << text("err");
  EXPECT_TRUE(exists("out/index.html"));
  EXPECT_EQ(json("out/study.json")["complete"], true);
  EXPECT_NE(text("err").find("no plots: interrupted"), std::string::npos) << text("err");
}

bool has_matplotlib() {
  for (const char* python : {"/usr/bin/python3"})
    if (run_command({python, "-c", "import matplotlib"}).exit_code == 0) return true;
  return false;
}

std::string chromium() {
  for (const char* path : {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"})
    if (std::filesystem::exists(path)) return path;
  return {};
}

size_t count(const std::string& text, const std::string& part) {
  size_t found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// Plots of every kind are drawn and embedded in the page, which loads nothing from elsewhere.
TEST_F(StudyReport, ThePageHoldsItsPlots) {
  if (!has_matplotlib()) GTEST_SKIP() << "there is no Python with matplotlib here";
  const CommandResult result =
      report({"--output", "out", "--only", "table2,table3,engines,queries,balance,figure2,figure3"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_EQ(result.err.find("no plots"), std::string::npos) << result.err;
  for (const char* plot : {"headline", "forms", "scaling", "queries", "balance", "figure3"})
    for (const char* extension : {".png", ".svg"}) EXPECT_TRUE(exists("out/" + std::string(plot) + extension)) << plot;
  const std::string page = text("out/index.html");
  EXPECT_EQ(count(page, "<img "), 7u);
  EXPECT_EQ(count(page, "src=\"data:"), 7u);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_EQ(count(page, "url("), count(page, "url(#"));
  EXPECT_EQ(count(page, "<svg "), 1u);  // Figure 1
  EXPECT_NE(page.find("Wei-Lun Huang"), std::string::npos);

  const std::string browser = chromium();
  if (browser.empty()) GTEST_SKIP() << "there is no Chromium here to open the page with";
  // A script that reports for every image whether it could be shown.
  folder_.write_text("out/checked.html", page +
                                             "<script>addEventListener('load', () => document.title = 'shown ' + "
                                             "[...document.images].filter(i => i.naturalWidth > 0).length)</script>");
  const CommandResult opened =
      run_command({browser, "--headless", "--no-sandbox", "--disable-gpu", "--user-data-dir=" + folder_.file("browser"),
                   "--enable-logging=stderr", "--dump-dom", "file://" + folder_.file("out/checked.html")});
  EXPECT_EQ(opened.exit_code, 0) << opened.err;
  EXPECT_NE(opened.out.find("<title>shown 7</title>"), std::string::npos) << opened.out.substr(0, 300);
  EXPECT_EQ(opened.err.find("CONSOLE"), std::string::npos) << opened.err;
}

TEST_F(StudyReport, TwoCanBeCompared) {
  without_plots();
  ASSERT_EQ(report({"--output", "a", "--only", "table1", "-q"}).exit_code, 0);
  const CommandResult same = run({"study", "compare", "a/study.json", "a/study.json"});
  EXPECT_EQ(same.exit_code, 0) << same.everything();
  EXPECT_NE(same.out.find("0 of 4 cells"), std::string::npos) << same.out;
  nlohmann::json slower = json("a/study.json");
  for (nlohmann::json& table : slower["tables"])
    for (nlohmann::json& cell : table["cells"]) {
      if (cell["row"] != "recursive (Algorithm 3)" || cell["column"] != "float") continue;
      for (const char* key : {"median", "min", "max"}) cell["seconds"][key] = 100 * cell["seconds"][key].get<double>();
      cell["nanoseconds_per_sample"] = 100 * cell["nanoseconds_per_sample"].get<double>();
    }
  slower["version"] = "another";
  folder_.write_text("b.json", slower.dump());
  const nlohmann::json j = only_json(run({"study", "compare", "a/study.json", "b.json", "--json"}).out);
  EXPECT_EQ(j["compared"], 4);
  ASSERT_EQ(j["changes"].size(), 1u);
  EXPECT_NEAR(j["changes"][0]["ratio"].get<double>(), 100, 1e-6);
  EXPECT_EQ(j["differences"].size(), 1u);
  EXPECT_NE(run({"study", "compare", "a", "a/"}).out.find("0 of 4 cells"), std::string::npos);
  const CommandResult empty = run({"study", "compare", "a", "."});
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_NE(empty.err.find("no study.json in this folder"), std::string::npos) << empty.err;
  EXPECT_EQ(run({"study", "compare", "a/study.json", "missing.json"}).exit_code, 2);
  EXPECT_EQ(run({"study", "compare", "a/study.json", "scene.pbrt"}).exit_code, 2);
  slower["deep"] = 0;
  std::string deep = slower.dump();
  deep.replace(deep.find("\"deep\":0"), 8, "\"deep\":" + std::string(200'000, '[') + std::string(200'000, ']'));
  folder_.write_text("deep.json", deep);
  const CommandResult nested = run({"study", "compare", "a/study.json", "deep.json"});
  EXPECT_EQ(nested.exit_code, 2) << nested.everything();
  EXPECT_EQ(nested.err.find("deep.json: the JSON is nested deeper than 128 levels: give "), 0u) << nested.err;
}

}  // namespace

}  // namespace alhazen::impl::test
