#pragma once

// Errors of the library within, as those of the public interface.

#include "alhazen/error.h"
#include "util/diagnostics.h"

namespace alhazen::impl {

template <class Work>
auto with_public_errors(const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw alhazen::InputError(error.what());
  } catch (const RenderError& error) {
    throw alhazen::Error(error.what());
  }
}

}  // namespace alhazen::impl
