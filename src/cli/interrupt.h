#pragma once

// Signals that ask the program to end, for subcommands that then write their results so far: Ctrl-C, SIGTERM, a lost
// terminal (SIGHUP), a limit on processor time (SIGXCPU).

namespace alhazen::impl {

/// From now on the first such signal is recorded, and a second one ends the program at once. Signals that were ignored
/// when the program started, such as SIGHUP by nohup, stay ignored.
void catch_interrupts();
bool is_interrupted();
/// A second signal writes this text, which must exist until then, to standard error before it ends the program.
void write_before_ending(const char* text);

}  // namespace alhazen::impl
