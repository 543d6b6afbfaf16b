#pragma once

// Turns errors of the CUDA runtime into messages that say what to do.

#include <cuda_runtime_api.h>

#include <string>

namespace alhazen::impl::cuda {

/// Returns why no GPU can be used, and what to do.
std::string explain_no_device(cudaError_t error);

/// Throws RenderError, or InputError if a setting is the cause, unless `result` is a success. `doing` completes the
/// sentence "the GPU failed while ...".
void check(cudaError_t result, const char* doing);

}  // namespace alhazen::impl::cuda
