#pragma once

// Temporary files that are not left behind: who makes one holds a lock on it, and one without a lock is of a process
// that was killed.

#include <string>

namespace alhazen {

/// A name in `folder` that no other process and no other thread of this one picks. Short, so that the longest of file
/// names still has a temporary beside it.
std::string temporary_path(const std::string& folder);

/// Takes the lock that says that the file is in use. False where another process has it, which is about to remove it.
bool lock_temporary(int descriptor);

/// Removes the temporary files of this user in `folder` that nobody holds. Looks once a folder and process.
void remove_abandoned_temporaries(const std::string& folder);

}  // namespace alhazen
