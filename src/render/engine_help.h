#pragma once

// The help of --backend and --strategy, generated from the traits of the backends.

#include <string>

namespace alhazen::impl {

std::string backend_help();
std::string strategy_help();

}  // namespace alhazen::impl
