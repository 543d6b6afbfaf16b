#pragma once

// Small studies, run as a user would; the user's own files are not touched.

#include <cstdlib>

#include "cli/fixture.h"

namespace alhazen::impl::test {

class StudyCommand : public Command {
 protected:
  StudyCommand() {
    set("ALHAZEN_TUNED", folder_.file("config/tuned.json"));
    set("MPLCONFIGDIR", folder_.file("matplotlib"));
  }
  ~StudyCommand() override {
    set("ALHAZEN_TUNED", "");
    unsetenv("MPLCONFIGDIR");
    unsetenv("ALHAZEN_PYTHON");
  }

  static void set(const char* name, const std::string& value) { setenv(name, value.c_str(), 1); }
  static void without_plots() { set("ALHAZEN_PYTHON", "/nonexistent/python"); }

  /// Runs `alhazen study report` on the small scene, in images of `size`, with `arguments` appended.
  CommandResult report(const std::vector<std::string>& arguments, const CommandOptions& options = {},
                       const std::string& size = "16") const {
    std::vector<std::string> all{"study", "report", "--quick", "--scene",   "scene.pbrt", "--size",
                                 size,    "--spp",  "4",       "--repeats", "2"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all, options);
  }

  /// Uses a shell script as the Python that draws plots.
  void use_as_python(const std::string& script) const {
    folder_.write_text("python", "#!/bin/sh\n" + script);
    std::filesystem::permissions(folder_.file("python"), std::filesystem::perms::owner_all);
    set("ALHAZEN_PYTHON", folder_.file("python"));
  }

  std::string text(const std::string& name) const {
    const Bytes bytes = read_file(folder_.file(name));
    return {bytes.begin(), bytes.end()};
  }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(text(name)); }
};

}  // namespace alhazen::impl::test
