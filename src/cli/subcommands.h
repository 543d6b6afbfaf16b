#pragma once

// The subcommands. Each adds its options to the program and runs if it is selected.

#include <CLI/CLI.hpp>

namespace alhazen {

/// Exit codes of the program.
inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_interrupted = 130;

/// `exit_code` receives the program's exit code if it is not that of success.
CLI::App* register_render(CLI::App& app, int& exit_code);
CLI::App* register_compare(CLI::App& app);
CLI::App* register_devices(CLI::App& app);
CLI::App* register_info(CLI::App& app);
/// `study` and its subcommands.
CLI::App* register_study(CLI::App& app, int& exit_code);
void register_study_report(CLI::App& study, int& exit_code);
void register_study_tune(CLI::App& study, int& exit_code);
void register_study_compare(CLI::App& study);

}  // namespace alhazen
