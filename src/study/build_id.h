#pragma once

#include <string>

namespace alhazen::impl::study {

/// What the linker has derived from the contents of this library, in hexadecimal: the same for the same code alone.
/// Empty if it was linked without (--build-id=none).
std::string build_id();

}  // namespace alhazen::impl::study
