#pragma once

// The linear scan, under the name that tests know it by.

#include "core/bvh/brute_force/linear.h"

namespace alhazen::test {

using alhazen::LinearIntersector;

}  // namespace alhazen::test
