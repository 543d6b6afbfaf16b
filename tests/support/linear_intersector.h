#pragma once

// The linear scan, under its name in the tests.

#include "core/bvh/brute_force/linear.h"

namespace alhazen::test {

using alhazen::LinearIntersector;

}  // namespace alhazen::test
