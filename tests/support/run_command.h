#pragma once

// Runs a program as a user would, captures its output, errors and exit code, and can send it signals.

#include <csignal>
#include <functional>
#include <string>
#include <vector>

namespace alhazen::impl::test {

struct CommandResult {
  int exit_code = -1;  ///< 128 + the signal if one ended it
  std::string out, err;
  double seconds = 0;
  bool timed_out = false;

  std::string everything() const {
    return "exit code " + std::to_string(exit_code) + (timed_out ? " (timed out)" : "") + "\nstdout:\n" + out +
           "\nstderr:\n" + err;
  }
};

struct CommandOptions {
  std::string folder;        ///< working folder; empty: the current one
  double timeout = 120;      ///< seconds until it is killed
  size_t address_space = 0;  ///< limit in bytes; 0: none
  size_t file_size = 0;      ///< limit on the size of a file in bytes; 0: none
  /// Called with the whole of stderr each time it grows. A number above 0 is sent as a signal, once.
  std::function<int(const std::string& err)> signal_when;
};

/// `command` is the program and its arguments; no shell interprets it.
CommandResult run_command(const std::vector<std::string>& command, const CommandOptions& options = {});

/// Runs a script of /bin/sh in which $ALHAZEN is the program under test.
CommandResult run_script(const std::string& script, const CommandOptions& options = {});

/// Runs the program under test with `arguments`.
CommandResult run_alhazen(std::vector<std::string> arguments, const CommandOptions& options = {});

}  // namespace alhazen::impl::test
