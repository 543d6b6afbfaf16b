// For walks that are compiled for no instruction set in particular.

#include "core/bvh/simd_in_double.h"
