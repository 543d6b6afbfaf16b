#pragma once

// Temporary files that are cleaned up: their creator holds a lock on them, so a file without a lock belongs to a
// process that was killed.

#include <string>

namespace alhazen::impl {

/// A name in `folder` that no other process or thread uses. It is short, so that it fits next to the longest file
/// names.
std::string temporary_path(const std::string& folder);

/// Takes the lock that marks the file as in use. Returns false if another process holds it, which is about to remove
/// it.
bool lock_temporary(int descriptor);

/// Removes the user's temporary files in `folder` that are not locked, once per folder and process.
void remove_abandoned_temporaries(const std::string& folder);

}  // namespace alhazen::impl
