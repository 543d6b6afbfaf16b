#include "study/plots.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "study/folder.h"
#include "study/plot_script.h"
#include "study/write.h"
#include "util/diagnostics.h"

extern char** environ;

namespace alhazen::impl::study {

namespace {

namespace fs = std::filesystem;

constexpr auto poll_interval = std::chrono::milliseconds(20);
/// Number of intervals after which a child that has been asked to end is killed.
constexpr int patience = 50;

/// Waits for the end of a child process and returns its exit code, or -1 if a signal ended it. Once `go_on` returns
/// false, the child is ended.
int wait_for(pid_t child, const GoOn& go_on) {
  int status = 0;
  for (int since_asked = -1;; std::this_thread::sleep_for(poll_interval)) {
    const pid_t ended = ::waitpid(child, &status, WNOHANG);
    if (ended == child) return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    if (ended < 0 && errno != EINTR) return -1;
    if (since_asked < 0 && go_on()) continue;
    if (++since_asked == 0) ::kill(child, SIGTERM);
    if (since_asked == patience) ::kill(child, SIGKILL);
  }
}

/// Runs a program of PATH and waits for it. Returns its exit code, or -1 if there is no such program or `go_on` has
/// ended it. Its output goes to the file `log`.
int run_program(std::vector<std::string> words, const std::string& log, const GoOn& go_on) {
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
  return problem == 0 ? wait_for(child, go_on) : -1;
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
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "alhazen-plots-XXXXXX").string();
    if (!error && mkdtemp(name.data())) path_ = name;
  }
  ~WorkFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;

  bool is_there() const { return !path_.empty(); }
  std::string path() const { return path_.string(); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  fs::path path_;
};

/// Copies the plots that were drawn to the folder of the study. Returns what could not be written, in one line.
std::string take_plots(const WorkFolder& work, const std::string& folder) {
  std::string problems;
  for (const Plot& plot : all_plots())
    for (const char* extension : plot_extensions) {
      const std::string name = std::string(plot.name) + extension;
      std::ifstream drawn(work.file(name), std::ios::binary);
      if (!drawn) continue;
      try {
        write_text(in_folder(folder, name), {std::istreambuf_iterator<char>(drawn), {}});
      } catch (const RenderError& failure) {
        problems += (problems.empty() ? "" : "; ") + std::string(failure.what());
      }
    }
  return problems;
}

}  // namespace

const std::vector<Plot>& all_plots() {
  static const std::vector<Plot> plots{
      {"headline", "headline", "How many times as fast as one core"},
      {"scaling", "table3", "Speedup by threads and schedule"},
      {"forms", "table2", "Four forms of OpenMP"},
      {"batches", "batches", "Time of a sample, a path at a time and in batches"},
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

std::string draw_plots(const std::string& folder, const GoOn& go_on) {
  const std::string interrupted = "no plots: interrupted; the same command with --resume draws them";
  if (!go_on()) return interrupted;
  const WorkFolder work;
  if (!work.is_there()) return "no plots: there is no folder for temporary files (TMPDIR)";
  const std::string script = work.file("study_plots.py"), log = work.file("log");
  try {
    write_text(script, std::string(plot_script()));
  } catch (const RenderError& failure) {
    return std::string("no plots: ") + failure.what();
  }
  for (const std::string& python : candidates()) {
    if (run_program({python, "-c", "import matplotlib"}, log, go_on) != 0) {
      if (!go_on()) return interrupted;
      continue;
    }
    const int code = run_program({python, script, folder, work.path()}, log, go_on);
    const std::string problems = take_plots(work, folder);
    if (code != 0)
      return go_on() ? "plots that could not be drawn by " + python + ": " + last_line_of(log) : interrupted;
    return problems.empty() ? "" : "plots that could not be written: " + problems;
  }
  return "no plots: no Python with matplotlib was found; to have them, install matplotlib (Debian: "
         "python3-matplotlib), "
         "or name a Python that has it in ALHAZEN_PYTHON, and run the same command with --resume";
}

}  // namespace alhazen::impl::study
