// The subcommand `alhazen study tune`, and its effect on --backend auto.

#include "cli/study_fixture.h"
#include "study/tuned.h"

namespace alhazen::impl::test {

namespace {

class StudyTune : public StudyCommand {
 protected:
  /// The statistics of a render of the small scene.
  nlohmann::json statistics(const std::vector<std::string>& arguments = {}) const {
    std::vector<std::string> all{"-o", "a.png", "--spp", "4", "-q", "--stats=json"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const CommandResult result = render(all);
    EXPECT_EQ(result.exit_code, 0) << result.everything();
    EXPECT_EQ(result.err, "");
    return only_json(result.out);
  }

  /// Stores an engine for the small scene, or for every scene, as `--store` does when it is certain of it.
  void store_engine(const char* strategy, const char* schedule, int threads, bool for_every_scene = false) const {
    study::TunedEntry entry;
    entry.machine = study::machine_key();
    entry.scene = for_every_scene ? study::any_scene : study::scene_key(folder_.file("scene.pbrt"));
    entry.precision = Settings().precision;
    entry.integrator = "path";
    entry.version = version();
    entry.engine.backend = "openmp";
    entry.engine.strategy = strategy;
    entry.engine.schedule = schedule;
    entry.engine.threads = threads;
    study::store_tuned(study::tuned_path(), entry);
  }
};

TEST_F(StudyTune, PrintsACommandThatRenders) {
  const CommandResult result = run({"study", "tune", "scene.pbrt", "--budget", "3"});
  ASSERT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_LT(result.seconds, 30);
  EXPECT_FALSE(exists("config/tuned.json"));
  const std::string command = lines_of(result.out).back();
  ASSERT_EQ(command.find("alhazen render scene.pbrt --backend "), 0u) << result.out;
  std::vector<std::string> words;
  std::string word;
  for (const char c : command.substr(std::string("alhazen render scene.pbrt ").size()) + " ") {
    if (c != ' ') {
      word += c;
      continue;
    }
    words.push_back(word);
    word.clear();
  }
  words.insert(words.end(), {"--spp", "4", "-o", "tuned.png"});
  EXPECT_EQ(render(words).exit_code, 0) << command;
}

/// A winner is stored if it is certain, which depends on what else the machine does.
TEST_F(StudyTune, StoresTheWinnerOrSaysWhyNot) {
  for (const std::string budget : {"1", "4"}) {
    const CommandResult result = run({"study", "tune", "scene.pbrt", "--budget", budget, "--store", "-q"});
    if (result.exit_code == 0) {
      EXPECT_EQ(json("config/tuned.json")["entries"].size(), 1u);
      EXPECT_EQ(result.err, "");
    } else if (result.exit_code == 1) {
      EXPECT_FALSE(exists("config/tuned.json"));
      EXPECT_EQ(result.err.find("nothing is stored: "), 0u) << result.err;
      EXPECT_EQ(lines_of(result.err).size(), 1u) << result.err;
    } else {
      // On a busy machine not even the first round fits into a second.
      EXPECT_NE(result.err.find("give a larger --budget"), std::string::npos) << result.everything();
    }
    std::filesystem::remove_all(folder_.file("config"));
  }
}

TEST_F(StudyTune, WhatIsStoredIsUsedByAutoAlone) {
  store_engine("collapse", "guided", 3);
  nlohmann::json j = statistics();
  EXPECT_EQ(j["strategy"], "collapse");
  EXPECT_EQ(j["schedule"], "guided");
  EXPECT_EQ(j["threads"], 3);
  EXPECT_EQ(statistics({"--backend", "serial"})["backend"], "serial");
  EXPECT_EQ(statistics({"--threads", "2"})["strategy"], "tiles");
  EXPECT_EQ(statistics({"--precision", "double"})["strategy"], "tiles");  // another key
  EXPECT_EQ(statistics({"--integrator", "iterative"})["strategy"], "tiles");
  folder_.write_text("scene.pbrt", cornell_box(24) + "# another file\n");
  EXPECT_NE(statistics()["strategy"], "collapse");
}

TEST_F(StudyTune, ADefaultIsForEveryScene) {
  store_engine("rows", "static", 2, true);
  folder_.write_text("scene.pbrt", cornell_box(24) + "# another file\n");
  EXPECT_EQ(statistics()["strategy"], "rows");
  const Bytes before = read_file(folder_.file("config/tuned.json"));
  store_engine("collapse", "guided", 3);
  EXPECT_EQ(statistics()["strategy"], "collapse");
  EXPECT_EQ(json("config/tuned.json")["entries"].size(), 2u);
  EXPECT_NE(read_file(folder_.file("config/tuned.json")), before);
}

/// A bad file never prevents a render: there is one warning.
TEST_F(StudyTune, ABrokenOrStaleFileIsOneWarning) {
  store_engine("collapse", "guided", 3);
  const std::string good = text("config/tuned.json");
  nlohmann::json stale = nlohmann::json::parse(good), gone = stale, wrong = stale;
  stale["entries"][0]["version"] = "0.0.1";
  gone["entries"][0]["engine"]["backend"] = "abacus";
  wrong["entries"][0]["engine"]["schedule"] = "never";
  const std::string texts[] = {"",         "{",          "[]",        "{\"schema\": \"alhazen-tuned-1\"}",
                               "\xff\xfe", stale.dump(), gone.dump(), wrong.dump()};
  for (const std::string& text : texts) {
    folder_.write_text("config/tuned.json", text);
    const CommandResult result = render({"-o", "a.png", "--spp", "4", "-q"});
    EXPECT_EQ(result.exit_code, 0) << text << result.everything();
    const std::vector<std::string> lines = lines_of(result.err);
    ASSERT_EQ(lines.size(), 1u) << text << result.err;
    EXPECT_EQ(lines[0].find("warning: "), 0u);
    EXPECT_NE(lines[0].find("tuned.json"), std::string::npos) << lines[0];
  }
  EXPECT_EQ(run({"study", "tune", "scene.pbrt", "--budget", "2"}).exit_code, 0);
  folder_.write_text("config/tuned.json", "{");
  const CommandResult store = run({"study", "tune", "scene.pbrt", "--budget", "2", "--store"});
  EXPECT_EQ(store.exit_code, 2) << store.everything();
  EXPECT_EQ(text("config/tuned.json"), "{");
}

TEST_F(StudyTune, ADeeplyNestedFileIsOnlyAWarning) {
  store_engine("collapse", "guided", 3);
  nlohmann::json file = json("config/tuned.json");
  file["entries"][0]["engine"]["threads"] = "deep";
  std::string text = file.dump();
  text.replace(text.find("\"deep\""), 6, std::string(200'000, '[') + std::string(200'000, ']'));
  folder_.write_text("config/tuned.json", text);
  const CommandResult result = render({"-o", "a.png", "--spp", "4", "-q"});
  EXPECT_EQ(result.exit_code, 0) << result.everything();
  EXPECT_NE(result.err.find("nested deeper than 128 levels"), std::string::npos) << result.err;
}

/// Also before a budget of ten minutes is spent.
TEST_F(StudyTune, WhatCannotBeStoredIsRefusedAtOnce) {
  for (const std::string& path : {std::string(), folder_.file("scene.pbrt/tuned.json"), folder_.path()}) {
    set("ALHAZEN_TUNED", path);
    for (const char* option : {"--store", "--store-default"}) {
      const CommandResult result = run({"study", "tune", "scene.pbrt", "--budget", "600", option});
      EXPECT_EQ(result.exit_code, 2) << path << result.everything();
      EXPECT_EQ(result.err.find("round"), std::string::npos) << result.err;
    }
  }
}

TEST_F(StudyTune, TheFileLiesWhereTheVariablesSay) {
  unsetenv("ALHAZEN_TUNED");
  set("XDG_CONFIG_HOME", folder_.file("xdg"));
  store_engine("collapse", "guided", 3);
  EXPECT_TRUE(exists("xdg/alhazen/tuned.json"));
  EXPECT_EQ(statistics()["strategy"], "collapse");
  unsetenv("XDG_CONFIG_HOME");
  set("ALHAZEN_TUNED", "");
  EXPECT_EQ(run({"study", "tune", "scene.pbrt", "--budget", "2", "--store", "-q"}).exit_code, 2);
}

/// Also in the first round, before every engine has run.
TEST_F(StudyTune, InterruptedItStoresNothing) {
  CommandOptions options;
  options.signal_when = [](const std::string& err) { return err.find("round 1") == std::string::npos ? 0 : SIGINT; };
  const CommandResult result = run({"study", "tune", "scene.pbrt", "--budget", "600", "--store"}, options);
  EXPECT_EQ(result.exit_code, 130) << result.everything();
  EXPECT_NE(result.err.find("interrupted: nothing is stored"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("budget"), std::string::npos) << result.err;
  EXPECT_FALSE(exists("config/tuned.json"));
}

TEST_F(StudyTune, RefusesBadInput) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"missing.pbrt"},
                                             {"scene.pbrt", "--budget", "0"},
                                             {"scene.pbrt", "--precision", "half"},
                                             {"scene.pbrt", "--store", "--store-default"},
                                             {}}) {
    std::vector<std::string> all{"study", "tune"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    EXPECT_EQ(run(all).exit_code, 2);
  }
  EXPECT_EQ(run({"study"}).exit_code, 2);
}

}  // namespace

}  // namespace alhazen::impl::test
