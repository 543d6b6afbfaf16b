#pragma once

// Kernels that no backend uses: they take samples by `iterative` and `sobol` alone.

#include "render/renderer.h"
#include "study/trial.h"

namespace alhazen::impl::study {

/// The kernel of `queries`, which is not of_backend, for the best instruction set of this processor.
KernelChoice kernel_of(Queries queries, Precision precision);

}  // namespace alhazen::impl::study
