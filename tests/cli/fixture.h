#pragma once

// A fixture that runs the program in a folder with a small scene.

#include <nlohmann/json.hpp>

#include "images/image.h"
#include "support/run_command.h"
#include "support/scene_files.h"
#include "support/temporary_folder.h"

namespace alhazen::impl::test {

class Command : public ::testing::Test {
 protected:
  Command() { folder_.write_text("scene.pbrt", cornell_box(24)); }

  CommandResult run(const std::vector<std::string>& arguments, CommandOptions options = {}) const {
    options.folder = folder_.path();
    return run_alhazen(arguments, options);
  }

  /// Runs `alhazen render scene.pbrt` quickly and quietly, with `arguments` appended.
  CommandResult render(const std::vector<std::string>& arguments, const CommandOptions& options = {}) const {
    std::vector<std::string> all{"render", "scene.pbrt"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all, options);
  }

  bool exists(const std::string& name) const { return std::filesystem::exists(folder_.file(name)); }
  Image image(const std::string& name) const { return read_image(folder_.file(name)); }

  TemporaryFolder folder_;
};

/// A function for scripts of /bin/sh: waits for the first report of the render $p in the file err. If the render ends
/// without one, or has none after a minute, the script ends with a message.
inline const std::string wait_for_samples = R"(wait_for_samples() {
  for i in $(seq 1200); do
    is_running=1; kill -0 $p 2>/dev/null || is_running=0
    if grep -qs samples_done err; then return; fi
    if [ $is_running = 0 ]; then break; fi
    sleep 0.05
  done
  echo "no samples came"; cat err; kill -9 $p 2>/dev/null; exit 1
}
)";

/// Parses the only line of `text`; fails if there is another one.
inline nlohmann::json only_json(const std::string& text) {
  EXPECT_FALSE(text.empty());
  EXPECT_EQ(text.find('\n'), text.size() - 1) << text;
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << text;
  return json;
}

inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

}  // namespace alhazen::impl::test
