#pragma once

// Reads what a module's file says of itself, before anything of it is loaded.

#include <optional>
#include <string>

#include "util/module_identity.h"

namespace alhazen {

/// The identity in the shared object `path`; nothing where the file is not a whole one, or no module of Alhazen.
std::optional<ModuleIdentity> read_module_identity(const std::string& path);

}  // namespace alhazen
