#pragma once

// Ctrl-C, for subcommands that write what they have: the first signal asks for an end, the second ends the program.

namespace alhazen {

void catch_interrupts();
bool is_interrupted();

}  // namespace alhazen
