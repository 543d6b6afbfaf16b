// Compiled once an instruction set, for the walks of the sample kernels.

#include "core/bvh/simd_in_double.h"
