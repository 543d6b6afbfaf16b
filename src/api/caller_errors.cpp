#include "api/caller_errors.h"

#include <new>
#include <stdexcept>

#include "alhazen/error.h"

namespace alhazen::impl {

namespace {

/// Made when the library is loaded, since making one takes memory, and copying it does not.
const OutOfMemoryError out_of_memory(
    "out of memory: the task needs more than this machine, or a limit set on it, allows");

}  // namespace

void rethrow_to_caller() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    throw OutOfMemoryError(out_of_memory);
  } catch (const std::length_error&) {
    throw OutOfMemoryError(out_of_memory);
  }
}

}  // namespace alhazen::impl
