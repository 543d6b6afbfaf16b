#pragma once

// Runs a program as a person would: its output, its errors, its exit code, and signals sent to it.

#include <csignal>
#include <functional>
#include <string>
#include <vector>

namespace alhazen::test {

struct CommandResult {
  int exit_code = -1;  ///< 128 + the signal where one ended it
  std::string out, err;
  double seconds = 0;
  bool timed_out = false;

  std::string everything() const {
    return "exit code " + std::to_string(exit_code) + (timed_out ? " (timed out)" : "") + "\nstdout:\n" + out +
           "\nstderr:\n" + err;
  }
};

struct CommandOptions {
  std::string folder;        ///< to run in; empty: here
  double timeout = 120;      ///< seconds, then it is killed
  size_t address_space = 0;  ///< bytes it may map; 0: any number
  size_t file_size = 0;      ///< bytes that a file may get; 0: any number
  /// Called with all that stderr holds each time it grows. A number above 0 is sent as a signal, once.
  std::function<int(const std::string& err)> signal_when;
};

/// `command` is the program and its arguments; nothing of it is seen by a shell.
CommandResult run_command(const std::vector<std::string>& command, const CommandOptions& options = {});

/// Runs a script of /bin/sh in which $ALHAZEN is the program under test.
CommandResult run_script(const std::string& script, const CommandOptions& options = {});

/// Runs the program under test with `arguments`.
CommandResult run_alhazen(std::vector<std::string> arguments, const CommandOptions& options = {});

}  // namespace alhazen::test
