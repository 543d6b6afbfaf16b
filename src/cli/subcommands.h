#pragma once

// The subcommands. Each adds its options to the program and runs if it is selected.

namespace alhazen::impl {

class Command;

/// Exit codes of the program.
inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_bad_input = 2;
inline constexpr int exit_interrupted = 130;

/// `exit_code` receives the program's exit code if it is not that of success.
void register_render(Command& program, int& exit_code);
void register_view(Command& program, int& exit_code);
void register_compare(Command& program, int& exit_code);
void register_devices(Command& program);
void register_info(Command& program);
/// `study` and its subcommands.
void register_study(Command& program, int& exit_code);
void register_study_report(Command& study, int& exit_code);
void register_study_tune(Command& study, int& exit_code);
void register_study_compare(Command& study);

}  // namespace alhazen::impl
