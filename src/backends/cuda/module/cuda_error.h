#pragma once

// Errors of the CUDA runtime as sentences that say what to do.

#include <cuda_runtime_api.h>

#include <string>

namespace alhazen::cuda {

/// Why no GPU can be used, and what to do.
std::string explain_no_device(cudaError_t error);

/// Throws RenderError, or InputError where a setting is to blame, unless `result` is a success. `doing` ends the
/// sentence "the GPU failed while ...".
void check(cudaError_t result, const char* doing);

}  // namespace alhazen::cuda
