#pragma once

// Reads the identity of a module from its file, without loading it.

#include <optional>
#include <string>

#include "util/module_identity.h"

namespace alhazen::impl {

/// Returns the identity in the shared object `path`, or nothing if the file is truncated or not a module of Alhazen.
std::optional<ModuleIdentity> read_module_identity(const std::string& path);

}  // namespace alhazen::impl
