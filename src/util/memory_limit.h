#pragma once

// How much memory there is. Systems promise more than they have and end the program when it is used, so that much is
// not asked for.

#include <cstdint>
#include <string>

namespace alhazen {

/// Bytes of this machine, or of what the control groups of this process leave it, as those of a container do.
uint64_t physical_memory();

/// The least limit of the control groups that a process is in and of those about them, version 2 or 1; the largest
/// number where there is none or it cannot be read. `process`: the folder of the process in /proc.
uint64_t control_group_memory(const std::string& process);

}  // namespace alhazen
