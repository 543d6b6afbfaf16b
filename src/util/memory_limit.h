#pragma once

// How much memory is available. Systems promise more than they have and kill the program when it is used, so programs
// should not allocate that much.

#include <cstdint>
#include <string>

namespace alhazen::impl {

/// Returns the memory of this machine in bytes, or less if control groups limit the process, as in containers.
uint64_t physical_memory();

/// Returns the smallest limit of the control groups of a process and their ancestors, version 2 or 1, in bytes; the
/// largest number if there is none or it cannot be read. `process`: the folder of the process in /proc.
uint64_t control_group_memory(const std::string& process);

}  // namespace alhazen::impl
