#include "support/run_command.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <stdexcept>

namespace alhazen::impl::test {

namespace {

using Clock = std::chrono::steady_clock;

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    close(read_end);
    close_write_end();
  }
  void close_write_end() {
    if (write_end >= 0) close(write_end);
    write_end = -1;
  }
};

[[noreturn]] void become(std::vector<char*>& arguments, const CommandOptions& options, const Pipe& out,
                         const Pipe& err) {
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(127);
  if (options.address_space > 0) {
    const rlimit limit{options.address_space, options.address_space};
    setrlimit(RLIMIT_AS, &limit);
  }
  if (options.file_size > 0) {
    const rlimit limit{options.file_size, options.file_size};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  const int nothing = open("/dev/null", O_RDONLY);
  dup2(nothing, STDIN_FILENO);
  dup2(out.write_end, STDOUT_FILENO);
  dup2(err.write_end, STDERR_FILENO);
  execv(arguments[0], arguments.data());
  _exit(127);
}

/// Appends the available data; returns false at the end of the stream.
bool drain(int descriptor, std::string& text) {
  char buffer[65536];
  const ssize_t count = read(descriptor, buffer, sizeof(buffer));
  if (count > 0) text.append(buffer, static_cast<size_t>(count));
  return count > 0;
}

}  // namespace

CommandResult run_command(const std::vector<std::string>& command, const CommandOptions& options) {
  std::vector<std::string> words = command;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Pipe out, err;
  const Clock::time_point start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) become(arguments, options, out, err);
  out.close_write_end();
  err.close_write_end();

  CommandResult result;
  bool out_open = true, err_open = true, signalled = !options.signal_when;
  while (out_open || err_open) {
    if (!result.timed_out && seconds() > options.timeout) {
      result.timed_out = true;
      kill(child, SIGKILL);
    }
    pollfd streams[2] = {{out_open ? out.read_end : -1, POLLIN, 0}, {err_open ? err.read_end : -1, POLLIN, 0}};
    if (poll(streams, 2, 50) <= 0) continue;
    if (streams[0].revents != 0) out_open = drain(out.read_end, result.out);
    if (streams[1].revents != 0) err_open = drain(err.read_end, result.err);
    if (signalled) continue;
    if (const int signal_number = options.signal_when(result.err); signal_number > 0) {
      kill(child, signal_number);
      signalled = true;
    }
  }
  int status = 0;
  waitpid(child, &status, 0);
  result.seconds = seconds();
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

CommandResult run_script(const std::string& script, const CommandOptions& options) {
  return run_command({"/bin/sh", "-c", "ALHAZEN='" ALHAZEN_BINARY "'\n" + script}, options);
}

CommandResult run_alhazen(std::vector<std::string> arguments, const CommandOptions& options) {
  arguments.insert(arguments.begin(), ALHAZEN_BINARY);
  return run_command(arguments, options);
}

}  // namespace alhazen::impl::test
