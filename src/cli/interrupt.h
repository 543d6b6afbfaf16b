#pragma once

// Signals that ask for an end, for subcommands that write what they have: Ctrl-C, SIGTERM, a lost terminal (SIGHUP), a
// limit on processor time (SIGXCPU).

namespace alhazen {

/// From here on the first such signal is remembered, and a second one ends the program at once. Those that the program
/// was started with as ignored, as SIGHUP is by nohup, stay ignored.
void catch_interrupts();
bool is_interrupted();

}  // namespace alhazen
