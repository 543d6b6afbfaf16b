#include "study/plots.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "study/plot_script.h"

extern char** environ;

namespace alhazen::study {

namespace {

namespace fs = std::filesystem;

/// Runs a program of PATH and waits for it. Returns its exit code, or -1 if there is no such program. Its output goes
/// to the file `log`.
int run_program(std::vector<std::string> words, const std::string& log) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  // The child does not inherit ignored signals.
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t usual;
  sigemptyset(&usual);
  for (const int signal_number : {SIGPIPE, SIGXFSZ}) sigaddset(&usual, signal_number);
  posix_spawnattr_setsigdefault(&attributes, &usual);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  pid_t child = 0;
  const int problem = posix_spawnp(&child, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::vector<std::string> candidates() {
  if (const char* asked = std::getenv("ALHAZEN_PYTHON"); asked && *asked) return {asked};
  return {"/usr/bin/python3", "python3"};
}

std::string last_line_of(const fs::path& path) {
  std::ifstream file(path);
  std::string line, last;
  while (std::getline(file, line))
    if (!line.empty()) last = line;
  return last;
}

/// A temporary folder for the script and its output, removed at the end.
class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (fs::temp_directory_path() / "alhazen-plots-XXXXXX").string();
    if (mkdtemp(name.data())) path_ = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  bool is_there() const { return !path_.empty(); }
  std::string file(const char* name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

}  // namespace

const std::vector<Plot>& all_plots() {
  static const std::vector<Plot> plots{
      {"headline", "headline", "How many times as fast as one core"},
      {"scaling", "table3", "Speedup by threads and schedule"},
      {"forms", "table2", "Four forms of OpenMP"},
      {"blocks", "table4", "CUDA by block size"},
      {"chunks", "table5", "CUDA by block and chunks"},
      {"figure3", "figure3", "Mean number of bounces of every thread"},
      {"balance", "balance", "How evenly threads are busy"},
      {"queries", "queries", "Time per ray"},
      {"depth", "depth", "Rays and time of a camera sample by depth"},
      {"glass", "glass", "Rays and time of a camera sample by depth, in a cloud of glass"},
      {"objects", "objects", "Time per ray by the number of objects"},
      {"error", "error", "Error against time"},
  };
  return plots;
}

std::string draw_plots(const std::string& folder) {
  std::error_code ignored;
  for (const Plot& plot : all_plots())
    for (const char* extension : {".png", ".svg"})
      fs::remove(fs::path(folder) / (std::string(plot.name) + extension), ignored);
  const WorkFolder work;
  if (!work.is_there()) return "no plots: there is no folder for temporary files (TMPDIR)";
  {
    std::ofstream script(work.file("study_plots.py"));
    script << plot_script();
  }
  for (const std::string& python : candidates()) {
    if (run_program({python, "-c", "import matplotlib"}, work.file("log")) != 0) continue;
    if (run_program({python, work.file("study_plots.py"), folder}, work.file("log")) == 0) return {};
    return "plots that could not be drawn by " + python + ": " + last_line_of(work.file("log"));
  }
  return "no plots: no Python with matplotlib was found; to have them, install matplotlib (Debian: "
         "python3-matplotlib), "
         "or name a Python that has it in ALHAZEN_PYTHON, and run the same command with --resume";
}

}  // namespace alhazen::study
